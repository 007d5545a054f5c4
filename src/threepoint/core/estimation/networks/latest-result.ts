import { reasonOf } from '../../errors/reasons';
import { allFinite } from '../../math/all-finite';
import type { PoseRegressor } from './pose-regressor';

/**
 * Runs a regressor one run at a time and keeps its newest result; errors are stored in `fault`, never thrown.
 */
export class LatestResult {
  readonly #regressor: PoseRegressor;
  /** A copy: `runNow` overwrites its result in the next run, which may be another body's. */
  readonly #output: Float32Array;
  #isValid = false;
  #running: Promise<void> | null = null;
  #fault: string | null = null;
  #epoch = 0;

  constructor(regressor: PoseRegressor) {
    this.#regressor = regressor;
    const [outputs] = regressor.contract.outputs;
    this.#output = new Float32Array(outputs?.shape.reduce((product, size) => product * size, 1) ?? 0);
  }

  /** The newest valid result; null: there is none, or a run has failed since. */
  get output(): Float32Array | null {
    return this.#isValid ? this.#output : null;
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

  /** Discards the newest result and that of the current run. */
  reset(): void {
    this.#isValid = false;
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
    if (output.length !== this.#output.length) {
      throw new Error(`${output.length} numbers came out, the contract says ${this.#output.length}`);
    }
    if (!allFinite(output)) throw new Error('the output has numbers that are not finite');
    this.#output.set(output);
    this.#isValid = true;
    this.#fault = null;
  }

  #fail(error: unknown): void {
    this.#isValid = false;
    this.#fault = `${this.#regressor.contract.name}: ${reasonOf(error)}`;
  }
}
