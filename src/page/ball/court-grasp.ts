import type { ObjectHolds } from 'threepoint/avatar/hands/hold-object';
import type { MutableHandShape } from 'threepoint/core/body/hand-shape';
import { type Pose, transformPoint } from 'threepoint/core/math/pose';
import { rotate } from 'threepoint/core/math/quat';
import type { Side } from 'threepoint/core/math/side';
import { vec3 } from 'threepoint/core/math/vec3';
import { basketRadius, rimTube } from 'threepoint-games/ball/basket';
import { ballRadius } from 'threepoint-games/ball/flight';
import { ballInPalm } from 'threepoint-games/fist';
import type { BallPlay } from './match/ball-play';

/** The basket's rim, floor frame. */
const rim = { at: vec3(0, 0, 0), normal: vec3(0, 1, 0), radius: basketRadius, tube: rimTube };
/** The ball in a hand, floor frame. */
const heldAt = vec3(0, 0, 0);

/** Closes a hand around the basket or a ball. Returns false if it holds neither. */
export function graspAtCourt(
  { newest, floorFromArena }: Pick<BallPlay, 'newest' | 'floorFromArena'>,
  side: Side,
  wrist: Pose<'floor'>,
  holding: ObjectHolds,
  target: MutableHandShape,
): boolean {
  if (!newest) return false;
  if (newest.role !== 'holder') {
    if (newest.held[side] === null) return false;
    holding.ball(side, wrist, { at: ballInPalm(wrist, ballRadius, heldAt), radius: ballRadius }, target);
    return true;
  }
  if (!newest.opening) return false;
  transformPoint(floorFromArena, newest.opening.position, rim.at);
  rotate(floorFromArena.orientation, newest.opening.normal, rim.normal);
  holding.rim(side, wrist, rim, target);
  return true;
}
