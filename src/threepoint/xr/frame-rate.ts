/** A rate is held when fewer frames than this share are late over a window of this length [s]. */
const lateShare = 0.01;
const windowSeconds = 10;
/** A frame that takes more than this many intervals of the device is late. */
const lateAfterIntervals = 1.5;
/** A higher rate is tried only if the work of a frame leaves this share of its interval to compositor and graphics. */
const workShare = 0.6;
/** Frames right after the start or a change of the rate do not count [s]. */
const settleSeconds = 1;
/** A rate that was not held is tried again after this time [s], which doubles with each failure up to the second. */
const shortestRetry = 60;
const longestRetry = 960;

/** The part of an XRSession that has rates; browsers without the choice lack all of it. */
export interface RatedSession {
  readonly frameRate?: number | undefined;
  readonly supportedFrameRates?: ArrayLike<number> | null | undefined;
  readonly updateTargetFrameRate?: ((rate: number) => Promise<void>) | undefined;
}

/** How often a rate was not held, and when it may be tried again [s]. */
interface Failures {
  readonly count: number;
  readonly retryAt: number;
}

/**
 * Chooses the highest frame rate that the page holds: fewer than 1 % late frames over ten seconds. It lowers the rate
 * as soon as a window has failed and raises it step by step after windows with time to spare; a rate that failed is
 * tried again later each time.
 */
export class FrameRateControl {
  /** The rates that the device offers [Hz], ascending; empty: it offers no choice. */
  readonly rates: readonly number[];
  readonly #session: RatedSession;
  readonly #failures = new Map<number, Failures>();
  #last = Number.NaN;
  #windowStart = Number.NaN;
  #late = 0;
  #heavy = 0;
  /** The rate that the device was asked for and does not run at yet [Hz]; null: none. */
  #requested: number | null = null;

  constructor(session: RatedSession) {
    this.#session = session;
    const rates = session.updateTargetFrameRate ? Array.from(session.supportedFrameRates ?? []) : [];
    this.rates = rates.length < 2 ? [] : rates.sort((a, b) => a - b);
  }

  /** The rate that the device runs at [Hz]; null: it does not report it. */
  get rate(): number | null {
    return this.#session.frameRate ?? null;
  }

  /** Starts a new window: what was counted does not compare with what follows. */
  restart(): void {
    this.#last = Number.NaN;
    this.#windowStart = Number.NaN;
  }

  /** Counts a frame at this time [s] whose work took this long [s], and asks the device for another rate if needed. */
  observe(time: number, workSeconds: number): void {
    const { rate } = this;
    if (rate === null || this.rates.length === 0) return;
    const interval = time - this.#last;
    this.#last = time;
    if (Number.isNaN(interval)) {
      this.#begin(time);
      return;
    }
    if (time < this.#windowStart) return;
    // A pause, however long, is one late frame.
    if (interval > lateAfterIntervals / rate) this.#late += 1;
    const next = this.rates.find((higher) => higher > rate);
    if (next !== undefined && workSeconds > workShare / next) this.#heavy += 1;
    const allowed = lateShare * windowSeconds * rate;
    if (this.#late > allowed) this.#lower(rate, time);
    else if (time - this.#windowStart >= windowSeconds) {
      if (next !== undefined && this.#heavy <= allowed) this.#raise(next, time);
      this.#begin(time - settleSeconds);
    }
  }

  #begin(time: number): void {
    this.#windowStart = time + settleSeconds;
    this.#late = 0;
    this.#heavy = 0;
  }

  #lower(rate: number, time: number): void {
    const lower = this.rates.findLast((each) => each < rate);
    const count = (this.#failures.get(rate)?.count ?? 0) + 1;
    const retryAt = time + Math.min(longestRetry, shortestRetry * 2 ** (count - 1));
    this.#failures.set(rate, { count, retryAt });
    this.#begin(time);
    if (lower !== undefined) this.#ask(lower);
  }

  #raise(rate: number, time: number): void {
    if (time >= (this.#failures.get(rate)?.retryAt ?? 0)) this.#ask(rate);
  }

  #ask(rate: number): void {
    if (this.#requested !== null) return;
    this.#requested = rate;
    const answered = () => {
      this.#requested = null;
      this.restart();
    };
    // reason: a device that refuses a rate stays at its own, and the next window decides again
    this.#session.updateTargetFrameRate?.(rate).then(answered, answered);
  }
}
