import type { BodySolverOptions } from 'threepoint/api/body-solver';
import { runWork, type WorkProgress } from 'threepoint/api/run-work';
import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import { createEstimator, networkOf } from 'threepoint/core/estimation/estimators';
import type { EstimatorName } from 'threepoint/core/estimation/pose-estimator';
import type { Replayable } from 'threepoint/core/tracking/recording';
import { type JointErrors, meanErrors } from './joint-errors';
import type { Truth } from './truth';

/** Mean errors of a method over a clip, how far measuring them is, or why there are none. */
export type ClipMean = JointErrors | WorkProgress | string;

const notBegun: WorkProgress = { fraction: 0, secondsLeft: null };

/** Measures methods over a whole clip, one after the other, while the page continues to draw. */
export class ClipMeans {
  readonly #recording: Replayable;
  readonly #truth: Truth;
  readonly #networks: BodySolverOptions['networks'];
  readonly #means = new Map<EstimatorName, ClipMean>();
  readonly #giveUp = new AbortController();
  #busy = false;

  constructor(recording: Replayable, truth: Truth, networks: BodySolverOptions['networks']) {
    this.#recording = recording;
    this.#truth = truth;
    this.#networks = networks;
  }

  /** What is known of a method; the first that nothing is known of is measured next. */
  of(name: EstimatorName): ClipMean {
    if (!this.#busy && !this.#means.has(name)) void this.#measure(name);
    return this.#means.get(name) ?? notBegun;
  }

  /** Gives up what is being measured. */
  dispose(): void {
    this.#giveUp.abort();
  }

  async #measure(name: EstimatorName): Promise<void> {
    const { signal } = this.#giveUp;
    this.#busy = true;
    this.#means.set(name, notBegun);
    try {
      this.#means.set(name, await this.#run(name, signal));
    } catch (error) {
      this.#means.set(name, firstLine(reasonOf(error)));
    } finally {
      // What was given up begins no other.
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
