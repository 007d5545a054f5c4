import { assertCalibration, type Calibration } from '../body/calibration';
import { transformJoints } from './joint-positions';
import type { JointSource } from './joint-source';
import { createDeviceSource } from './methods/device';
import { createHandsOnly } from './methods/hands-only';
import { createResidual } from './methods/residual';
import type { PoseRegressor } from './networks/pose-regressor';
import { Pipeline, type PipelineOptions } from './pipeline';
import { type EstimatorName, estimatorNames, type PaperMethod, type PoseEstimator } from './pose-estimator';

export type NetworkName = 'paper' | 'learned';

/** The methods that cannot work without their network. */
export type NetworkMethod = NetworkName | PaperMethod;

export const needsRegressor = (name: EstimatorName): name is NetworkMethod =>
  name === 'paper' || name === 'paper-published' || name === 'learned';

/**
 * Returns the network that a method loads, or null. `device` uses `learned` as its fallback, but also works without it.
 */
export function networkOf(name: EstimatorName): NetworkName | null {
  if (name === 'paper-published') return 'paper';
  if (name === 'device') return 'learned';
  return needsRegressor(name) ? name : null;
}

/** The joints of inverse kinematics, uncorrected. */
const ikAlone: JointSource = {
  network: null,
  calibrate: () => undefined,
  reset: () => undefined,
  joints({ ik, floorFromHeading }, _, target) {
    transformJoints(floorFromHeading, ik.joints, target);
  },
};

/** Creates an estimator by inverse kinematics alone: the baseline of the networks, with the same calibration. */
export const createIk = (calibration: Calibration, options?: PipelineOptions): Pipeline =>
  new Pipeline('ik', calibration, ikAlone, options);

/** Throws an Error if a regressor belongs to another method. */
export function assertNetwork(
  name: NetworkMethod,
  regressor: PoseRegressor | null,
): asserts regressor is PoseRegressor {
  const network = networkOf(name);
  if (regressor?.contract.name !== network) throw new Error(`estimator “${name}” needs the regressor of “${network}”`);
}

/** Creates an estimator by the learned network; throws an Error for the regressor of another method. */
export function createLearned(
  calibration: Calibration,
  regressor: PoseRegressor | null,
  options?: PipelineOptions,
): Pipeline {
  assertNetwork('learned', regressor);
  return new Pipeline('learned', calibration, createResidual(calibration, regressor), options);
}

/**
 * Creates an estimator by its name. Throws an Error for a method without the regressor that it needs; `device` without
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
  options: PipelineOptions = {},
): PoseEstimator {
  assertCalibration(calibration);
  options.pinning?.assertOffsets(calibration);
  if (name === 'learned') return createLearned(calibration, regressor, options);
  if (name === 'device') {
    const otherwise = regressor ? createResidual(calibration, regressor) : ikAlone;
    return new Pipeline(name, calibration, createDeviceSource(otherwise), options);
  }
  if (name === 'ik') return createIk(calibration, options);
  if (name === 'hands-only') return createHandsOnly(calibration);
  if (needsRegressor(name)) {
    assertNetwork(name, regressor);
    const create = regressor.methods?.[name];
    if (create) return create(calibration, options);
  }
  throw new RangeError(`“${String(name)}” is not an estimator. Use one of ${estimatorNames.join(', ')}.`);
}
