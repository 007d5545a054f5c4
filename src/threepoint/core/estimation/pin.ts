import { smoothstep } from '../math/damper';
import {
  copyPose,
  invertTransform,
  type MutablePose,
  makePose,
  makeTransform,
  type Pose,
  transformPose,
} from '../math/pose';

/** The time [s] in which a joint passes from its estimate to its tracker, or back. */
export const handOverSeconds = 0.3;

/** A joint that a tracker pins, and its way there and back. */
export interface Pin {
  /** The time that has passed on the way from the estimate to the tracker, as a part of it: 0 to 1. */
  share: number;
  /** The pinned joint in the frame of the estimated one; keeps its last value while the tracker is lost. */
  readonly difference: MutablePose<'joint'>;
  /** The pinned joint, floor frame; while the tracker is lost, where it would be by the last difference. */
  readonly target: MutablePose<'floor'>;
}

export const makePin = (): Pin => ({ share: 0, difference: makePose(), target: makePose() });

const jointFromFloor = makeTransform<'joint', 'floor'>();

/**
 * Advances a pin by `step` (part of the transition) and writes its target. Returns its weight: 0 where the estimate
 * stands, 1 where the target does. pinned: the joint by its tracker; null: not seen.
 */
export function followPin(pin: Pin, estimated: Pose<'floor'>, pinned: Pose<'floor'> | null, step: number): number {
  const { difference, target } = pin;
  pin.share = pinned ? Math.min(1, pin.share + step) : Math.max(0, pin.share - step);
  if (pin.share === 0) return 0;
  if (pinned) {
    transformPose(invertTransform<'floor', 'joint'>(estimated, jointFromFloor), pinned, difference);
    copyPose(pinned, target);
  } else transformPose<'floor', 'joint'>(estimated, difference, target);
  return smoothstep(0, 1, pin.share);
}
