import type { LoadNetwork } from 'threepoint';
import {
  createEstimator,
  type EstimatorName,
  firstLine,
  networkOf,
  type PaperMethod,
  type Replayable,
  reasonOf,
} from 'threepoint/core';
import { runWork } from 'threepoint/internal';
import type { WorkProgress } from 'threepoint/motion';
import { type JointErrors, meanErrors } from './joint-errors';
import type { Truth } from './truth';

/** The mean errors of a method over a clip, the progress of measuring them, or the reason why there are none. */
export type ClipMean = JointErrors | WorkProgress | string;

const notStarted: WorkProgress = { fraction: 0, secondsLeft: null };

/** Measures methods over a whole clip, one after the other, while the page continues to draw. */
export class ClipMeans {
  readonly #recording: Replayable;
  readonly #truth: Truth;
  readonly #networks: LoadNetwork<PaperMethod>;
  readonly #means = new Map<EstimatorName, ClipMean>();
  readonly #cancellation = new AbortController();
  #busy = false;

  constructor(recording: Replayable, truth: Truth, networks: LoadNetwork<PaperMethod>) {
    this.#recording = recording;
    this.#truth = truth;
    this.#networks = networks;
  }

  /** Returns the mean errors of a method. If they are unknown, it is measured once no other method is. */
  errorsOf(name: EstimatorName): ClipMean {
    if (!this.#busy && !this.#means.has(name)) void this.#measure(name);
    return this.#means.get(name) ?? notStarted;
  }

  /** Cancels the measurement in progress. */
  dispose(): void {
    this.#cancellation.abort();
  }

  async #measure(name: EstimatorName): Promise<void> {
    const { signal } = this.#cancellation;
    this.#busy = true;
    this.#means.set(name, notStarted);
    try {
      this.#means.set(name, await this.#run(name, signal));
    } catch (error) {
      this.#means.set(name, firstLine(reasonOf(error)));
    } finally {
      // No measurement starts after a cancelled one.
      this.#busy = signal.aborted;
    }
  }

  async #run(name: EstimatorName, signal: AbortSignal): Promise<JointErrors> {
    const network = networkOf(name);
    const regressor = network && (await this.#networks(network));
    try {
      const estimator = createEstimator(name, this.#recording.calibration!, regressor);
      return await runWork(meanErrors(this.#recording, this.#truth, estimator), {
        signal,
        onProgress: (progress) => this.#means.set(name, progress),
      });
    } finally {
      await regressor?.dispose();
    }
  }
}
