import { type CheckStep, type MeasuredQuantity, openingSteps } from './check-steps';

/** The events of a sequence, reported within their frame. */
interface StepListener {
  /** A step begins with its lead. */
  begin(step: CheckStep): void;
  /** The lead is over: frames are measured from now on. */
  measure(step: CheckStep): void;
  /** The measured time is over. */
  end(step: CheckStep): void;
}

/**
 * Runs the opening steps and the remaining ones by the times of frames. The remaining steps depend on the results of
 * the opening steps: they are requested at first for a preview, and again when the opening steps are over.
 */
export class StepSequence {
  readonly #listener: StepListener;
  readonly #pace: number;
  readonly #remaining: () => readonly CheckStep[];
  #steps: readonly CheckStep[];
  #index = -1;
  /** When the step began [s]. */
  #since = Number.NaN;
  #measuring = false;

  /** `pace`: the factor of all durations. */
  constructor(options: {
    readonly remaining: () => readonly CheckStep[];
    readonly pace: number;
    readonly listener: StepListener;
  }) {
    this.#remaining = options.remaining;
    this.#steps = [...openingSteps, ...options.remaining()];
    this.#pace = options.pace;
    this.#listener = options.listener;
  }

  get steps(): readonly CheckStep[] {
    return this.#steps;
  }

  /** The current step; null: none has begun, or all are over. */
  get current(): CheckStep | null {
    return this.#steps[this.#index] ?? null;
  }

  get over(): boolean {
    return this.#index >= this.#steps.length;
  }

  /** The quantity that frames measure now; null: they measure nothing. */
  get measured(): MeasuredQuantity | null {
    return this.#measuring ? (this.current?.measured ?? null) : null;
  }

  /** Returns the rest of the current step, lead included [s]. */
  secondsLeft(time: number): number {
    const step = this.current;
    return step ? Math.max(0, this.#since + this.#pace * (step.leadSeconds + step.seconds) - time) : 0;
  }

  /** Advances to the time of a frame [s]. A frame ends at most one step, so that every step has frames. */
  advance(time: number): void {
    const step = this.current;
    if (!step) {
      if (this.#index < 0) this.#begin(0, time);
      return;
    }
    const elapsed = time - this.#since;
    if (!this.#measuring && elapsed >= this.#pace * step.leadSeconds) {
      this.#measuring = true;
      this.#listener.measure(step);
    }
    if (this.#measuring && elapsed >= this.#pace * (step.leadSeconds + step.seconds)) this.#end(step, time);
  }

  #end(step: CheckStep, time: number): void {
    this.#listener.end(step);
    if (this.#index === openingSteps.length - 1) this.#steps = [...openingSteps, ...this.#remaining()];
    this.#begin(this.#index + 1, time);
  }

  #begin(index: number, time: number): void {
    this.#index = index;
    this.#since = time;
    this.#measuring = false;
    if (this.current) this.#listener.begin(this.current);
  }
}
