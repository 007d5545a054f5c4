import type { Calibration } from '../body/calibration';
import { createHandsOnly } from './hands-only';
import { createIk } from './ik';
import { createLearned } from './learned';
import { withLevelGaze } from './level-gaze';
import { createPaper } from './paper';
import type { EstimatorName, PoseEstimator } from './pose-estimator';
import type { PoseRegressor } from './pose-regressor';

/** Whether a method needs a network. */
export const needsRegressor = (name: EstimatorName): name is 'paper' | 'learned' =>
  name === 'paper' || name === 'learned';

/** One estimator by name; `paper` and `learned` throw without their regressor. */
export function createEstimator(
  name: EstimatorName,
  calibration: Calibration,
  regressor: PoseRegressor | null = null,
): PoseEstimator {
  return withLevelGaze(ofName(name, calibration, regressor), calibration);
}

function ofName(name: EstimatorName, calibration: Calibration, regressor: PoseRegressor | null): PoseEstimator {
  if (needsRegressor(name)) {
    if (regressor?.contract.name !== name) throw new Error(`estimator “${name}” needs the regressor of the same name`);
    return name === 'paper' ? createPaper(calibration, regressor) : createLearned(calibration, regressor);
  }
  return name === 'ik' ? createIk(calibration) : createHandsOnly();
}
