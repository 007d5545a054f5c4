import type { Calibration } from '../../body/calibration';
import type { EstimatorFactory, PoseRegressor } from '../networks/pose-regressor';
import { Pipeline, type PipelineOptions } from '../pipeline';
import type { PaperMethod } from '../pose-estimator';
import { createPaper } from './paper';
import { createPaperOrientations } from './paper-orientations';

/**
 * Creates an estimator by the paper's network. `paper-published` is `paper` with the orientations of section 3.5 of the
 * paper: no torso and arm fitting, no filters, no trackers beyond head and hands.
 */
export function createPaperMethod(
  name: PaperMethod,
  calibration: Calibration,
  regressor: PoseRegressor,
  options?: PipelineOptions,
): Pipeline {
  const rule = name === 'paper-published' ? { orientations: createPaperOrientations() } : {};
  return new Pipeline(name, calibration, createPaper(regressor), { ...options, ...rule });
}

/** Returns the methods of the paper with its network. */
export const paperMethods = (regressor: PoseRegressor): Readonly<Record<PaperMethod, EstimatorFactory>> => ({
  paper: (calibration, options) => createPaperMethod('paper', calibration, regressor, options),
  'paper-published': (calibration, options) => createPaperMethod('paper-published', calibration, regressor, options),
});
