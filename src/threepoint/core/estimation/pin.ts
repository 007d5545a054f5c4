import { clamp, smoothstep } from '../math/damper';
import {
  copyPose,
  invertTransform,
  type MutablePose,
  makePose,
  makeTransform,
  type Pose,
  transformPose,
} from '../math/pose';
import { slerp } from '../math/quat';
import { lerp } from '../math/vec3';

/** The time [s] in which a joint passes from its estimate to its tracker, or back. */
export const handOverSeconds = 0.3;

/** The distances [m] beyond the reach of its bones at which confidence in a tracked joint starts to fall, and is 0. */
const doubtfulFrom = 0.1;
const lostFrom = 0.3;

/** Returns the confidence [0, 1] in a tracked joint that is `beyond` [m] out of the reach of its bones. */
export const confidenceBeyond = (beyond: number): number =>
  clamp((lostFrom - beyond) / (lostFrom - doubtfulFrom), 0, 1);

/** A joint that a tracker pins, and its way there and back. */
export interface Pin {
  /** The time that has passed on the way from the estimate to the tracker, as a part of it: 0 to 1. */
  fraction: number;
  /** The part that has passed of the time from the last difference before a loss to the tracker's own: 0 to 1. */
  regained: number;
  /** The pinned joint in the frame of the estimated one; keeps its last value while the tracker is lost. */
  readonly difference: MutablePose<'joint'>;
  /** The pinned joint, floor frame; while the tracker is lost, where it would be by the last difference. */
  readonly target: MutablePose<'floor'>;
}

export const makePin = (): Pin => ({ fraction: 0, regained: 0, difference: makePose(), target: makePose() });

const jointFromFloor = makeTransform<'joint', 'floor'>();
const seen = makePose<'joint'>();

/**
 * Advances a pin by `step` (part of the transition) and writes its target. Returns its weight: 0 where the estimate
 * stands, 1 where the target does. pinned: the joint by its tracker; null: not seen. confidence: in that joint, 0 to 1.
 */
export function followPin(
  pin: Pin,
  estimated: Pose<'floor'>,
  pinned: Pose<'floor'> | null,
  confidence: number,
  step: number,
): number {
  const { difference, target } = pin;
  const counts = pinned && confidence > 0 ? pinned : null;
  if (pin.fraction === 0) pin.regained = 1;
  else if (!counts) pin.regained = 0;
  const left = 1 - pin.regained;
  if (counts) pin.regained = Math.min(1, pin.regained + step);
  pin.fraction += clamp((counts ? confidence : 0) - pin.fraction, -step, step);
  if (pin.fraction === 0) return 0;
  if (counts) {
    transformPose(invertTransform<'floor', 'joint'>(estimated, jointFromFloor), counts, seen);
    const way = pin.regained === 1 ? 1 : step / left;
    lerp(difference.position, seen.position, way, difference.position);
    slerp(difference.orientation, seen.orientation, way, difference.orientation);
  }
  if (counts && pin.regained === 1) copyPose(counts, target);
  else transformPose<'floor', 'joint'>(estimated, difference, target);
  return smoothstep(0, 1, pin.fraction);
}
