import type { Calibration } from '../body/calibration';
import { assertNetwork, createLearned, type NetworkMethod } from './estimators';
import { createPaperMethod } from './methods/paper-methods';
import type { PoseRegressor } from './networks/pose-regressor';
import type { Pipeline, PipelineOptions } from './pipeline';

/**
 * Creates an estimator with a network as a pipeline, for benches of single stages; throws an Error for the regressor of
 * another method.
 */
export function createWithNetwork(
  name: NetworkMethod,
  calibration: Calibration,
  regressor: PoseRegressor | null,
  options?: PipelineOptions,
): Pipeline {
  if (name === 'learned') return createLearned(calibration, regressor, options);
  assertNetwork(name, regressor);
  return createPaperMethod(name, calibration, regressor, options);
}
