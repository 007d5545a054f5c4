import type { PoseEstimator } from './pose-estimator';

/** Head and hands as they are tracked, and no body. */
export function createHandsOnly(): PoseEstimator {
  return {
    name: 'hands-only',
    calibrate: () => undefined,
    reset: () => undefined,
    prepare: () => Promise.resolve(),
    estimate: ({ head, leftHand, rightHand }) => ({ head, leftHand, rightHand, body: null }),
    rawJoints: () => null,
    fault: () => null,
  };
}
