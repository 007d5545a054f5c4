import { reasonOf } from '../../errors/reasons';
import { allFinite } from '../../math/all-finite';
import type { PoseRegressor } from './pose-regressor';

/**
 * Runs a regressor one run at a time and passes on each finished result; errors are stored in `fault`, never thrown.
 */
export class LatestResult {
  readonly #regressor: PoseRegressor;
  readonly #outputs: number;
  readonly #finished: (output: Float32Array) => void;
  readonly #failed: () => void;
  #running: Promise<void> | null = null;
  #fault: string | null = null;
  #epoch = 0;

  /** `finished` is called with each valid result; `failed` when a run failed, which invalidates earlier results. */
  constructor(regressor: PoseRegressor, finished: (output: Float32Array) => void, failed: () => void) {
    this.#regressor = regressor;
    this.#outputs = regressor.contract.outputs[0]?.shape.reduce((product, size) => product * size, 1) ?? 0;
    this.#finished = finished;
    this.#failed = failed;
  }

  /** The current run; no other may be started before it settles. */
  get running(): Promise<void> | null {
    return this.#running;
  }

  /** The newest fault, until a run succeeds. */
  get fault(): string | null {
    return this.#fault;
  }

  /** Starts a run; resolves when it has settled. `features` may be overwritten then. */
  start(features: Float32Array): Promise<void> {
    this.#running ??= this.#run(features).finally(() => {
      this.#running = null;
    });
    return this.#running;
  }

  /** Runs a regressor synchronously (`runNow`); an error is stored in `fault`. Allocates nothing. */
  answerNow(features: Float32Array): void {
    try {
      this.#finish(this.#regressor.runNow!(features));
    } catch (error) {
      this.#fail(error);
    }
  }

  /** Discards the result of the current run. */
  reset(): void {
    this.#epoch += 1;
  }

  async #run(features: Float32Array): Promise<void> {
    const startedIn = this.#epoch;
    try {
      const output = await this.#regressor.run(features);
      if (startedIn === this.#epoch) this.#finish(output);
    } catch (error) {
      this.#fail(error);
    }
  }

  #finish(output: Float32Array): void {
    if (output.length !== this.#outputs) {
      throw new Error(`${output.length} numbers came out, the contract says ${this.#outputs}`);
    }
    if (!allFinite(output)) throw new Error('the output has numbers that are not finite');
    this.#finished(output);
    this.#fault = null;
  }

  #fail(error: unknown): void {
    this.#failed();
    this.#fault = `${this.#regressor.contract.name}: ${reasonOf(error)}`;
  }
}
