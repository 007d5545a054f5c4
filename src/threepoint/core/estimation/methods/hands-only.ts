import type { Calibration } from '../../body/calibration';
import { type Fingers, unknownFingers } from '../../body/hand-shape';
import { makePose, type TrackedPose } from '../../math/pose';
import { HeadsetMountCorrection } from '../online-calibration/headset-mount-correction';
import type { PoseEstimator } from '../pose-estimator';

/** The result of `update`, overwritten by the next. */
interface OwnedPose {
  head: TrackedPose;
  leftHand: TrackedPose | null;
  rightHand: TrackedPose | null;
  readonly body: null;
  fingers: Fingers;
}

/** An estimator that returns head and hands as they are tracked, without a body. */
export function createHandsOnly(calibration: Calibration): PoseEstimator {
  const headset = new HeadsetMountCorrection(calibration);
  const pose: OwnedPose = {
    head: { ...makePose<'floor'>(), tracking: 'emulated' },
    leftHand: null,
    rightHand: null,
    body: null,
    fingers: unknownFingers,
  };
  const estimate = { pose, request: null };
  return {
    name: 'hands-only',
    calibrate: (next) => headset.calibrate(next),
    reset: () => undefined,
    update({ head, leftHand, rightHand, fingers = unknownFingers }) {
      pose.head = headset.apply(head, 0);
      pose.leftHand = leftHand;
      pose.rightHand = rightHand;
      pose.fingers = fingers;
      return estimate;
    },
    fault: () => null,
  };
}
