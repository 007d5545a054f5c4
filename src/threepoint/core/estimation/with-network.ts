import type { Calibration } from '../body/calibration';
import { assertNetwork, createLearned, type NetworkMethod } from './estimators';
import { createPaper } from './methods/paper';
import { createPaperOrientations } from './methods/paper-orientations';
import type { EstimatorFactory, PoseRegressor } from './networks/pose-regressor';
import { Pipeline, type PipelineOptions } from './pipeline';
import type { PaperMethod } from './pose-estimator';

/**
 * Creates an estimator with a network as a pipeline, for benches of single stages; throws an Error for the regressor of
 * another method. `paper-published` is `paper` with the orientations of section 3.5 of the paper: no torso and arm
 * fitting, no filters, no trackers beyond head and hands.
 */
export function createWithNetwork(
  name: NetworkMethod,
  calibration: Calibration,
  regressor: PoseRegressor | null,
  options?: PipelineOptions,
): Pipeline {
  if (name === 'learned') return createLearned(calibration, regressor, options);
  assertNetwork(name, regressor);
  const rule = name === 'paper-published' ? { orientations: createPaperOrientations() } : {};
  return new Pipeline(name, calibration, createPaper(regressor), { ...options, ...rule });
}

/** Returns the methods of the paper with its network. */
export const paperMethods = (regressor: PoseRegressor): Readonly<Record<PaperMethod, EstimatorFactory>> => ({
  paper: (calibration, options) => createWithNetwork('paper', calibration, regressor, options),
  'paper-published': (calibration, options) => createWithNetwork('paper-published', calibration, regressor, options),
});
