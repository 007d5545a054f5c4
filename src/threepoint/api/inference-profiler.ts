import type { PoseRegressor } from '../core/estimation/networks/pose-regressor';

/**
 * Measures what a body does on this thread after a frame. Each part is the time since the mark before it, or since
 * `resume`.
 */
export interface InferenceProfiler {
  /** Marks the start of work that a frame deferred. */
  resume(): void;
  /**
   * Marks the end of a part. features: until the network is called. inference: until the call first waits; work
   * elsewhere costs this thread nothing.
   */
  mark(part: 'features' | 'inference'): void;
}

/** Returns the regressor with profiled runs. A run within a frame belongs to that frame and is not profiled. */
export function withProfiler(regressor: PoseRegressor, profiler: InferenceProfiler): PoseRegressor {
  return {
    contract: regressor.contract,
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
