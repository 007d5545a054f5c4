import type { MutableHandShape } from 'threepoint/core';
import type { ObjectHolds } from 'threepoint/internal/three';
import { type Pose, rotate, type Side, transformPoint, vec3 } from 'threepoint/math';
import { ballInPalm } from 'threepoint-games';
import { ballRadius, basketRadius, rimTube } from 'threepoint-games/ball';
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
