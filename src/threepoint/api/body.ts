import type { NetworkName } from '../core/estimation/estimators';
import type { PoseRegressor } from '../core/estimation/pose-regressor';
import { BodySolver, type BodySolverOptions } from './body-solver';
import { learnedAlone } from './load-learned';

export interface BodyOptions extends Partial<BodySolverOptions> {
  /** Default: the learned one without a runtime. `onnxNetworks` of threepoint/onnx brings both. */
  readonly networks?: (name: NetworkName) => Promise<PoseRegressor>;
}

/** A body with the learned network without a runtime. Knows no renderer; BodyTracker of threepoint/three is this with a session and an avatar. */
export class Body extends BodySolver {
  /** Throws a RangeError where the calibration is no person's. */
  constructor(options: BodyOptions = {}) {
    super({ ...options, networks: options.networks ?? learnedAlone });
  }
}
