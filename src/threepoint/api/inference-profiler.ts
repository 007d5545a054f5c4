import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';

/**
 * Measures the work of a body on this thread after a frame. A part lasts from the previous mark, or from `resume`, to
 * its own mark.
 */
export interface InferenceProfiler {
  /** Marks the start of work that a frame deferred. */
  resume(): void;
  /**
   * Marks the end of a part. features: until the network is called. inference: until the call returns; work on other
   * threads is not included.
   */
  mark(part: 'features' | 'inference'): void;
}

/** Returns the regressor with its deferred runs profiled; runs within a frame are part of that frame's time. */
export function withProfiler(regressor: PoseRegressor, profiler: InferenceProfiler): PoseRegressor {
  return {
    contract: regressor.contract,
    methods: regressor.methods,
    // The provider changes when a graphics device is lost.
    get provider() {
      return regressor.provider;
    },
    run(features) {
      profiler.mark('features');
      const running = regressor.run(features);
      profiler.mark('inference');
      return running;
    },
    ...(regressor.runNow && { runNow: (features: Float32Array) => regressor.runNow!(features) }),
    dispose: () => regressor.dispose(),
  };
}
