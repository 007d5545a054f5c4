import { numberBetween } from 'threepoint/core/validation/validation';
import * as v from 'valibot';

/** Pauses kept per trial; of a trial with more, no clock is told: a way from one to the other with gaps is none. */
export const mostTrialPauses = 200;

const seconds = numberBetween(0, 1e11);

/** How the seconds of a trial, which stand in pauses, lie on the clock of its recording, which does not. */
export const trialClockSchema = v.object({
  /** Second 0 of the trial: seconds since 1970 by the device's clock, and the time of a frame recorded then. */
  epoch: seconds,
  start: seconds,
  /** At which second of the trial it stood, and for how long; times never fall. */
  pauses: v.pipe(
    v.array(v.object({ time: seconds, seconds })),
    v.maxLength(mostTrialPauses, `expected at most ${mostTrialPauses} pauses`),
  ),
});

export type TrialClock = v.InferOutput<typeof trialClockSchema>;

/** What adding and subtracting leaves of two times that are the same [s]; no frame is as short. */
const rounding = 1e-6;

/** When a second of the trial is on the clock of its recording; of a second at which the trial stood, when it went on. */
export const recordingTime = ({ start, pauses }: TrialClock, second: number): number =>
  pauses.reduce((time, pause) => (pause.time <= second + rounding ? time + pause.seconds : time), start + second);

/** Counts the seconds of one trial, frame by frame of the page's clock [s], which is that of recordings. */
export class TrialSeconds {
  readonly #now: () => number;
  #clock: { readonly epoch: number; readonly start: number } | null = null;
  readonly #pauses: { readonly time: number; readonly seconds: number }[] = [];
  #stood = 0;
  #stoppedAt: number | null = null;

  /** `now`: seconds since 1970. */
  constructor(now: () => number) {
    this.#now = now;
  }

  /** A frame in which the trial stands. */
  stand(pageTime: number): void {
    if (this.#clock) this.#stoppedAt ??= pageTime;
  }

  /** A frame in which it runs; the first is second 0. Returns the second of the trial. */
  run(pageTime: number): number {
    this.#clock ??= { epoch: this.#now(), start: pageTime };
    const { start } = this.#clock;
    if (this.#stoppedAt !== null) {
      const stood = pageTime - this.#stoppedAt;
      this.#pauses.push({ time: this.#stoppedAt - this.#stood - start, seconds: stood });
      this.#stood += stood;
      this.#stoppedAt = null;
    }
    return pageTime - this.#stood - start;
  }

  /** null: it has not begun, or stood too often. */
  get clock(): TrialClock | null {
    if (!this.#clock || this.#pauses.length > mostTrialPauses) return null;
    return { ...this.#clock, pauses: this.#pauses };
  }
}
