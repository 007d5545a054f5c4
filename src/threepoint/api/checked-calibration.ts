import { assertCalibration, type Calibration } from '../core/body/calibration';
import * as bodies from '../core/body/skeleton';
import * as estimators from '../core/estimation/estimators';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import type { Pinning } from '../core/estimation/pinning';
import type { EstimatorName, PoseEstimator } from '../core/estimation/pose-estimator';

// The functions of core that a page calls with measures of its own: measures in centimetres would give a giant.

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
 * Creates an estimator by its name. `paper` and `learned` throw without their regressor; `device` falls back on IK
 * without that of `learned`. Throws a RangeError where no estimator has this name, or where the measures [m] are not
 * human. `pinning` of threepoint/trackers draws the trackers of frames.
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
