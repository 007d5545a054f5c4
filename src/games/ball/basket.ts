import {
  add,
  addScaled,
  down,
  type Frame,
  forward,
  length,
  lerp,
  type MutableVec3,
  normalise,
  type Pose,
  reject,
  right as rightward,
  rotate,
  type Side,
  subtract,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { fallTime, type Launch, positionAt } from '../ballistics';
import { fistOf, thumbOf } from '../fist';
import { ballRadius } from './flight';

/** Radius of the basket's opening, and depth of its straight walls [m]. */
export const basketRadius = 0.22;
export const basketDepth = 0.3;
/** Radius of the rim's tube about the edge of the opening [m]. */
export const rimTube = 0.017;

/** Returns whether the middle of a launched ball goes into a level basket whose opening is here (arena frame). */
export function landsIn(launch: Launch, basket: Vec3): boolean {
  const lands = positionAt(launch, fallTime(launch, basket.y));
  return Math.hypot(lands.x - basket.x, lands.z - basket.z) < basketRadius - ballRadius / 2;
}

/** The opening of a basket: its centre, and the unit normal out of it. */
export interface Opening {
  readonly position: Vec3;
  readonly normal: Vec3;
}

/** An opening that its owner overwrites. */
export interface MutableOpening extends Opening {
  readonly position: MutableVec3;
  readonly normal: MutableVec3;
}

export const makeOpening = (): MutableOpening => ({ position: vec3(0, 0, 0), normal: vec3(0, 1, 0) });

/** Distance of a fist at the rim from the centre of the opening [m]; the palm lies on the rim from outside. */
export const gripRadius = basketRadius + 0.01;

const fist = vec3(0, 0, 0);
const otherFist = vec3(0, 0, 0);
const across = vec3(0, 0, 0);
const thumb = vec3(0, 0, 0);

/** Writes the opening of a basket in one hand. */
function openingInHand(side: Side, hand: Pose<Frame>, { position, normal }: MutableOpening): void {
  thumbOf(side, hand.orientation, normal);
  // The opening lies on the palm's side; if that is parallel to the thumb, on the knuckles' side.
  reject(rotate(hand.orientation, down, across), normal, across);
  normalise(across, rotate(hand.orientation, forward, thumb), across);
  addScaled(fistOf(hand, fist), across, gripRadius, position);
}

/**
 * Writes the opening of a basket that is held by its rim with one or both hands, palms inward and thumbs up, in the
 * frame of the hands. It opens where the thumbs point. Returns null if no hand is tracked.
 */
export function basketInHands(
  left: Pose<Frame> | null,
  right: Pose<Frame> | null,
  target: MutableOpening = makeOpening(),
): MutableOpening | null {
  if (!left || !right) {
    if (left) openingInHand('left', left, target);
    else if (right) openingInHand('right', right, target);
    return left || right ? target : null;
  }
  const { position, normal } = target;
  fistOf(left, fist);
  fistOf(right, otherFist);
  const line = length(subtract(otherFist, fist, across));
  normalise(across, rightward, across);
  add(thumbOf('left', left.orientation, normal), thumbOf('right', right.orientation, thumb), normal);
  if (line > 1e-3) reject(normal, across, normal);
  // Thumbs that point at each other or apart define no direction: the basket opens upward.
  if (!(length(normal) > 1e-3)) reject(up, across, normal);
  normalise(normal, up, normal);
  lerp(fist, otherFist, 0.5, position);
  return target;
}
