import type { CheckStep, Measured } from './check-steps';

/** The callbacks of a sequence, called within the frame of their event. */
export interface StepListener {
  /** A step begins; nothing of it counts yet. */
  begin(step: CheckStep): void;
  /** The lead is over: frames count from now on. */
  count(step: CheckStep): void;
  /** The time that counts is over. */
  end(step: CheckStep): void;
}

/**
 * Goes through steps by the time of frames. Steps that depend on what the first ones found are settled when those are
 * over; until then they are a preview.
 */
export class StepSequence {
  readonly #listener: StepListener;
  readonly #pace: number;
  readonly #first: readonly CheckStep[];
  readonly #more: () => readonly CheckStep[];
  #steps: readonly CheckStep[];
  #index = -1;
  /** When the step began [s]. */
  #since = Number.NaN;
  #counting = false;

  /** `pace`: all durations are multiplied by this. */
  constructor(options: {
    readonly first: readonly CheckStep[];
    readonly more: () => readonly CheckStep[];
    readonly pace: number;
    readonly listener: StepListener;
  }) {
    this.#first = options.first;
    this.#more = options.more;
    this.#steps = [...options.first, ...options.more()];
    this.#pace = options.pace;
    this.#listener = options.listener;
  }

  get steps(): readonly CheckStep[] {
    return this.#steps;
  }

  /** The step now; null: none has begun, or all are over. */
  get current(): CheckStep | null {
    return this.#steps[this.#index] ?? null;
  }

  get over(): boolean {
    return this.#index >= this.#steps.length;
  }

  /** The quantity that frames measure now; null: they do not count. */
  get measured(): Measured | null {
    return this.#counting ? (this.current?.measured ?? null) : null;
  }

  /** Returns how long the step still takes [s], lead included. */
  remaining(time: number): number {
    const step = this.current;
    return step ? Math.max(0, this.#since + this.#pace * (step.leadSeconds + step.seconds) - time) : 0;
  }

  /** Moves on to the time of a frame [s]; one frame ends one step at most, so that each has its frames. */
  advance(time: number): void {
    const step = this.current;
    if (!step) {
      if (this.#index < 0) this.#begin(0, time);
      return;
    }
    const elapsed = time - this.#since;
    if (!this.#counting && elapsed >= this.#pace * step.leadSeconds) {
      this.#counting = true;
      this.#listener.count(step);
    }
    if (this.#counting && elapsed >= this.#pace * (step.leadSeconds + step.seconds)) this.#end(step, time);
  }

  #end(step: CheckStep, time: number): void {
    this.#listener.end(step);
    if (this.#index === this.#first.length - 1) this.#steps = [...this.#first, ...this.#more()];
    this.#begin(this.#index + 1, time);
  }

  #begin(index: number, time: number): void {
    this.#index = index;
    this.#since = time;
    this.#counting = false;
    if (this.current) this.#listener.begin(this.current);
  }
}
