/** A rate is held when fewer frames than this fraction are late over a window of this length [s]. */
const lateFraction = 0.01;
const windowSeconds = 10;
/** All savings are taken at once if more than this fraction of the frames is late. */
const veryLateFraction = 0.05;
/** A frame that takes more than this many intervals of the device is late. */
const lateAfterIntervals = 1.5;
/** A higher rate is tried only if a frame's work leaves this fraction of its interval to compositor and graphics. */
const workFraction = 0.6;
/** Frames right after the start or a change of the rate do not count [s]. */
const settleSeconds = 1;
/** The time [s] after which a failed rate is tried again. It doubles with each failure, up to the second. */
const shortestRetry = 60;
const longestRetry = 960;

/** The part of an XRSession that has rates; browsers without the choice lack all of it. */
interface RatedSession {
  readonly frameRate?: number | undefined;
  readonly supportedFrameRates?: ArrayLike<number> | null | undefined;
  readonly updateTargetFrameRate?: ((rate: number) => Promise<void>) | undefined;
}

/** Reductions of the image quality that save time. */
export interface Savings {
  /** The fixed foveation, 0 to 1. */
  readonly foveation: number;
  /** The maximum rate of a mirror's reflections [Hz]; null: one in each frame. */
  readonly mirrorRateHz: number | null;
}

/** The levels of savings from none to all, least noticeable first. */
const levels: readonly Savings[] = [
  { foveation: 0, mirrorRateHz: null },
  { foveation: 0.5, mirrorRateHz: null },
  { foveation: 1, mirrorRateHz: null },
  { foveation: 1, mirrorRateHz: 36 },
];
const allSavings = levels.length - 1;

/** The savings while the load is unknown: all that do not affect mirrors. */
export const defaultSavings: Savings = { foveation: 1, mirrorRateHz: null };

/** The number of failures of a rate with some savings, and the time of the next attempt [s]. */
interface Failures {
  readonly count: number;
  readonly retryAt: number;
}

/**
 * Controls the frame rate by the load of the page: a rate is held with fewer than 1 % late frames over ten seconds.
 * After a failed window it takes savings, and with all of them the next lower rate. After a held window it tries the
 * next higher rate if there is time to spare, then fewer savings. A failed attempt is repeated later each time.
 */
export class FrameRateControl {
  /** The rates that the device offers [Hz], ascending; empty: it offers no choice. */
  readonly rates: readonly number[];
  readonly #session: RatedSession;
  readonly #failures = new Map<string, Failures>();
  /** The savings with which each rate was held. */
  readonly #heldAt = new Map<number, number>();
  #level = 0;
  #last = Number.NaN;
  #windowStart = Number.NaN;
  #frames = 0;
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

  get savings(): Savings {
    return this.rate === null ? defaultSavings : levels[this.#level]!;
  }

  /** Starts a new window, because earlier counts are not comparable. */
  restart(): void {
    this.#last = Number.NaN;
    this.#windowStart = Number.NaN;
  }

  /** Counts a frame at this time [s] whose work took this long [s]. */
  observe(time: number, workSeconds: number): void {
    const { rate } = this;
    if (rate === null) return;
    const interval = time - this.#last;
    this.#last = time;
    if (Number.isNaN(interval)) {
      this.#begin(time);
      return;
    }
    if (time < this.#windowStart) return;
    this.#frames += 1;
    // A pause, however long, is one late frame.
    if (interval > lateAfterIntervals / rate) this.#late += 1;
    const next = this.rates.find((higher) => higher > rate);
    if (next !== undefined && workSeconds > workFraction / next) this.#heavy += 1;
    const allowed = lateFraction * windowSeconds * rate;
    if (this.#late > allowed) this.#relieve(rate, time);
    else if (time - this.#windowStart >= windowSeconds) {
      this.#heldAt.set(rate, this.#level);
      this.#improve(rate, this.#heavy <= allowed ? next : undefined, time);
      this.#begin(time - settleSeconds);
    }
  }

  #begin(time: number): void {
    this.#windowStart = time + settleSeconds;
    this.#frames = 0;
    this.#late = 0;
    this.#heavy = 0;
  }

  /** Takes savings, or the next lower rate where there are no more. */
  #relieve(rate: number, time: number): void {
    const veryLate = this.#late > veryLateFraction * this.#frames;
    this.#fail(rate, time);
    this.#begin(time);
    if (this.#level < allSavings) {
      this.#level = veryLate ? allSavings : this.#level + 1;
      return;
    }
    const lower = this.rates.findLast((each) => each < rate);
    if (lower === undefined) return;
    this.#level = this.#heldAt.get(lower) ?? this.#level;
    this.#ask(lower);
  }

  /** Tries the next higher rate, where one is given, or fewer savings. */
  #improve(rate: number, next: number | undefined, time: number): void {
    if (next !== undefined && this.#mayTry(next, this.#level, time)) this.#ask(next);
    else if (this.#level > 0 && this.#mayTry(rate, this.#level - 1, time)) this.#level -= 1;
  }

  #fail(rate: number, time: number): void {
    const key = keyOf(rate, this.#level);
    const count = (this.#failures.get(key)?.count ?? 0) + 1;
    const retryAt = time + Math.min(longestRetry, shortestRetry * 2 ** (count - 1));
    this.#failures.set(key, { count, retryAt });
  }

  /** Returns whether a rate may be tried: what failed with more savings fails with fewer. */
  #mayTry(rate: number, level: number, time: number): boolean {
    for (let more = level; more <= allSavings; more++) {
      if (time < (this.#failures.get(keyOf(rate, more))?.retryAt ?? 0)) return false;
    }
    return true;
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

const keyOf = (rate: number, level: number): string => `${rate}:${level}`;
