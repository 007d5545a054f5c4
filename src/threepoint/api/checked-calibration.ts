import { assertCalibration, type Calibration } from '../core/body/calibration';
import * as bodies from '../core/body/skeleton';
import * as estimators from '../core/estimation/estimators';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import type { Pinning } from '../core/estimation/pinning';
import type { EstimatorName, PoseEstimator } from '../core/estimation/pose-estimator';

// Wrappers of functions of core that check a page's measures: measures in centimetres would give a giant.

/**
 * Returns the average body of this eye height and span [m]; identity rotations are an upright person in T-pose. Throws
 * a RangeError where the measures are not human.
 *
 * @example
 * const skeleton = skeletonFromCalibration({ eyeHeight: 1.6, armSpan: 1.5 });
 */
export function skeletonFromCalibration(calibration: Calibration): bodies.Skeleton {
  assertCalibration(calibration);
  return bodies.skeletonFromCalibration(calibration);
}

/**
 * Creates an estimator by its name. Throws an Error for `paper` and `learned` without their regressor; `device` without
 * that of `learned` falls back on IK. Throws a RangeError for an unknown name, or for measures [m] that no person has.
 * `pinning` of threepoint/trackers draws the trackers of frames.
 *
 * @example
 * const estimator = createEstimator('learned', calibration, await loadLearned());
 */
export function createEstimator(
  name: EstimatorName,
  calibration: Calibration,
  regressor: PoseRegressor | null = null,
  { pinning }: { readonly pinning?: Pinning } = {},
): PoseEstimator {
  assertCalibration(calibration);
  pinning?.assertOffsets(calibration);
  return estimators.createEstimator(name, calibration, regressor, { pinning });
}
