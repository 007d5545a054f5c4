import type { PoseRegressor } from './pose-regressor';

/** Runs a regressor one at a time and keeps its newest finished result; nothing it does wrong gets out as an exception. */
export interface Regression<Context> {
  /** Starts a run unless one is under way; resolves when it is finished, however it ends. */
  start(features: () => Float32Array, context: Context): Promise<void>;
  /** The newest finished result with the context of its frame; null before the first and after a fault. */
  newest(): { readonly output: Float32Array; readonly context: Context } | null;
  /** What went wrong last, until a run succeeds. */
  fault(): string | null;
  /** Forgets results, those still under way included. */
  reset(): void;
}

export function createRegression<Context>(regressor: PoseRegressor): Regression<Context> {
  let running: Promise<void> | null = null;
  let newest: { readonly output: Float32Array; readonly context: Context } | null = null;
  let fault: string | null = null;
  let epoch = 0;
  const outputs = regressor.contract.outputs[0]?.shape.reduce((product, size) => product * size, 1) ?? 0;

  async function run(features: Float32Array, context: Context): Promise<void> {
    const startedIn = epoch;
    try {
      const output = await regressor.run(features);
      if (startedIn !== epoch) return;
      if (output.length !== outputs) throw new Error(`${output.length} numbers came out, the contract says ${outputs}`);
      if (!output.every(Number.isFinite)) throw new Error('the output has numbers that are not finite');
      newest = { output, context };
      fault = null;
    } catch (error) {
      newest = null;
      fault = `${regressor.contract.name}: ${error instanceof Error ? error.message : String(error)}`;
    }
  }

  return {
    start(features, context) {
      if (running) return running;
      running = run(features(), context).finally(() => {
        running = null;
      });
      return running;
    },
    newest: () => newest,
    fault: () => fault,
    reset() {
      epoch += 1;
      newest = null;
    },
  };
}
