import type { Calibration } from '../body/calibration';
import { HeadsetPitch } from './headset-pitch';
import type { PoseEstimator } from './pose-estimator';

/** Head and hands as they are tracked, and no body. */
export function createHandsOnly(calibration: Calibration): PoseEstimator {
  const pitch = new HeadsetPitch(calibration);
  return {
    name: 'hands-only',
    calibrate: (next) => pitch.calibrate(next),
    reset: () => undefined,
    update: ({ head, leftHand, rightHand }) => ({
      pose: { head: pitch.level(head), leftHand, rightHand, body: null },
      request: null,
    }),
    fault: () => null,
  };
}
