import type { NetworkName } from '../core/estimation/estimators';
import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';
import { BodySolver, type BodySolverOptions } from './body-solver';
import { loadWithoutRuntime } from './load-learned';
import { warnOfFallback } from './warnings';

export interface BodyOptions extends Partial<BodySolverOptions> {
  /**
   * Loads a network by name. Default: the learned network without a runtime. `onnxNetworks` of threepoint/onnx loads
   * both.
   */
  readonly networks?: (name: NetworkName) => Promise<PoseRegressor>;
}

/**
 * A BodySolver with the learned network, without a runtime or a renderer. BodyTracker of threepoint/three adds a
 * session and an avatar.
 *
 * @example
 * const body = new Body({ calibration: { eyeHeight: 1.6, armSpan: 1.51 } });
 * const pose = body.update({ time, head, leftHand, rightHand });
 */
export class Body extends BodySolver {
  /**
   * Throws a RangeError where the calibration is not human or the estimator is unknown, a TypeError where an option is.
   */
  constructor(options: BodyOptions = {}) {
    super({
      ...options,
      events: { fallback: warnOfFallback, ...options.events },
      networks: options.networks ?? loadWithoutRuntime,
    });
  }
}
