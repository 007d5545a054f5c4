import type { AvatarPose } from '../../body/avatar-pose';
import type { Calibration } from '../../body/calibration';
import { unknownFingers } from '../../body/hand-shape';
import { makePose } from '../../math/pose';
import type { Mutable } from '../../records';
import { HeadsetMountCorrection } from '../online-calibration/headset-mount-correction';
import type { PoseEstimator } from '../pose-estimator';

/** An estimator that returns head and hands as they are tracked, without a body. */
export function createHandsOnly(calibration: Calibration): PoseEstimator {
  const headset = new HeadsetMountCorrection(calibration);
  /** The result of `update`, overwritten by the next. */
  const pose: Mutable<AvatarPose> = {
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
