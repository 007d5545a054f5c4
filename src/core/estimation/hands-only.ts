import type { Calibration } from '../body/calibration';
import type { PoseEstimator } from './pose-estimator';
import { WornHeadset } from './worn-headset';

/** Head and hands as they are tracked, and no body. */
export function createHandsOnly(calibration: Calibration): PoseEstimator {
  const headset = new WornHeadset(calibration);
  return {
    name: 'hands-only',
    calibrate: (next) => headset.calibrate(next),
    reset: () => undefined,
    update: ({ head, leftHand, rightHand }) => ({
      pose: { head: headset.head(head, 0), leftHand, rightHand, body: null },
      request: null,
    }),
    fault: () => null,
  };
}
