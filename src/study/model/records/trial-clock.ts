import { numberBetween } from 'threepoint/core';
import * as v from 'valibot';

/** The most pauses of a trial; a trial with more has no clock, because gaps would make the conversion wrong. */
export const maxTrialPauses = 200;

const seconds = numberBetween(0, 1e11);

/** The relation of the seconds of a trial, without pauses, to the clock of its recording, with pauses. */
export const trialClockSchema = v.object({
  /** Second 0 of the trial by the device's clock in seconds since 1970, and the time of its frame in the recording. */
  epoch: seconds,
  start: seconds,
  /** The second of the trial and the duration of each pause, in ascending order. */
  pauses: v.pipe(
    v.array(v.object({ time: seconds, seconds })),
    v.maxLength(maxTrialPauses, `expected at most ${maxTrialPauses} pauses`),
  ),
});

export type TrialClock = v.InferOutput<typeof trialClockSchema>;

/** The rounding error of two equal times after addition and subtraction [s], shorter than any frame. */
const rounding = 1e-6;

/** Returns the time of a second of the trial in the recording; for the second of a pause, its end. */
export const recordingTime = ({ start, pauses }: TrialClock, second: number): number =>
  pauses.reduce((time, pause) => (pause.time <= second + rounding ? time + pause.seconds : time), start + second);

/** Counts the seconds of a trial by the page's clock [s] of each frame, which is also that of recordings. */
export class TrialStopwatch {
  readonly #now: () => number;
  #clock: { readonly epoch: number; readonly start: number } | null = null;
  readonly #pauses: { readonly time: number; readonly seconds: number }[] = [];
  #pausedSeconds = 0;
  #stoppedAt: number | null = null;

  /** `now` returns seconds since 1970. */
  constructor(now: () => number) {
    this.#now = now;
  }

  /** Counts a frame in a pause. */
  pause(pageTime: number): void {
    if (this.#clock) this.#stoppedAt ??= pageTime;
  }

  /** Counts a frame outside of pauses, the first as second 0; returns the second of the trial. */
  run(pageTime: number): number {
    this.#clock ??= { epoch: this.#now(), start: pageTime };
    const { start } = this.#clock;
    if (this.#stoppedAt !== null) {
      const paused = pageTime - this.#stoppedAt;
      this.#pauses.push({ time: this.#stoppedAt - this.#pausedSeconds - start, seconds: paused });
      this.#pausedSeconds += paused;
      this.#stoppedAt = null;
    }
    return pageTime - this.#pausedSeconds - start;
  }

  /** The clock of the trial; null: the trial has not begun, or had too many pauses. */
  get clock(): TrialClock | null {
    if (!this.#clock || this.#pauses.length > maxTrialPauses) return null;
    return { ...this.#clock, pauses: this.#pauses };
  }
}
