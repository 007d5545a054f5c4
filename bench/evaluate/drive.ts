import type { Calibration } from '../../src/core/body/calibration';
import { forwardKinematics } from '../../src/core/body/forward-kinematics';
import { skeletonFromCalibration } from '../../src/core/body/skeleton';
import { createEstimator } from '../../src/core/estimation/estimators';
import type { EstimatorName } from '../../src/core/estimation/pose-estimator';
import type { PoseRegressor } from '../../src/core/estimation/pose-regressor';
import type { Vec3 } from '../../src/core/math/vec3';
import type { MeasuredFrame } from './measures';
import type { RecordedFrame } from './recordings';

/** Methods that have a body to measure; hands-only has none. */
export const measuredMethods = ['ik', 'paper', 'learned'] as const satisfies readonly EstimatorName[];
export type MeasuredMethod = (typeof measuredMethods)[number];

/** Drives the shipping path over one clip, frame by frame as the page would. */
export async function drive(
  name: MeasuredMethod,
  calibration: Calibration,
  regressor: PoseRegressor | null,
  frames: readonly RecordedFrame[],
): Promise<MeasuredFrame[]> {
  const estimator = createEstimator(name, calibration, regressor);
  const skeleton = skeletonFromCalibration(calibration);
  const result: MeasuredFrame[] = [];
  for (const { frame, truth } of frames) {
    // The network is asked when the picture is drawn and answers from a worker: what a frame draws was computed from the one before.
    const { body } = estimator.estimate(frame);
    await estimator.prepare(frame);
    if (estimator.fault()) throw new Error(`${name}: ${estimator.fault()}`);
    if (!body) throw new Error(`${name} drew no body`);
    const joints: Record<string, Vec3> = {};
    for (const [joint, { position }] of Object.entries(forwardKinematics(skeleton, body))) joints[joint] = position;
    result.push({
      joints,
      truth,
      raw: estimator.rawJoints(),
      wrists: { left: frame.leftHand?.position ?? null, right: frame.rightHand?.position ?? null },
    });
  }
  return result;
}
