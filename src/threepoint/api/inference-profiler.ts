import type { PoseRegressor } from '../core/estimation/pose-regressor';

/** Hears what a body does on this thread once a frame is over. Each part is the time since the mark before it, or since `resume`. */
export interface InferenceProfiler {
  /** Work begins that a frame left for later. */
  resume(): void;
  /** features: until the network is asked. inference: what it takes before it first waits; what runs elsewhere is no cost of this thread. */
  mark(part: 'features' | 'inference'): void;
}

/** The same regressor, with its runs told. One that answers within the frame is part of that frame and not told. */
export function profiled(regressor: PoseRegressor, timing: InferenceProfiler): PoseRegressor {
  return {
    contract: regressor.contract,
    // Live: it changes with a graphics device that is lost.
    get provider() {
      return regressor.provider;
    },
    run(features) {
      timing.mark('features');
      const running = regressor.run(features);
      timing.mark('inference');
      return running;
    },
    ...(regressor.runNow && { runNow: (features: Float32Array) => regressor.runNow!(features) }),
    dispose: () => regressor.dispose(),
  };
}
