/** Answers older than this [s] are discarded, because clocks drift. */
const memory = 30;
const eager = { asks: 5, every: 0.2 } as const;
const every = 2;
/** After this long without an answer, or between two calls [s], the estimate is reset. */
const longestSilence = 5;

/** An answer: when it arrived, and the other clock minus this one by it [s]. */
interface Answer {
  readonly receivedAt: number;
  readonly offset: number;
  readonly roundTrip: number;
}

/**
 * Estimates the offset of another clock from timed requests, by the answer with the shortest round trip, half of which
 * bounds its error. Clocks in seconds, monotonic; a gap of more than 5 s between two calls of `due` counts as a pause
 * of the machine.
 */
export class ClockSync {
  #answers: Answer[] = [];
  #trips: readonly number[] = [];
  /** The time of the oldest open request. */
  #unanswered: number | null = null;
  #asked = 0;
  #nextAsk = Number.NEGATIVE_INFINITY;
  #lastCall: number | null = null;
  /** Answers to requests from before a pause are ignored. */
  #askedFrom = Number.NEGATIVE_INFINITY;
  #best: Omit<Answer, 'receivedAt'> = { offset: 0, roundTrip: Number.POSITIVE_INFINITY };

  /** The other clock minus this one [s]; 0 before the first answer. */
  get offset(): number {
    return this.#best.offset;
  }

  /** Round trip of the answer from which `offset` is taken [s]; Infinity before the first. */
  get roundTrip(): number {
    return this.#best.roundTrip;
  }

  /** Returns whether to send a request now: often at first, then every two seconds. */
  isDue(now: number): boolean {
    if (this.#lastCall !== null && Math.abs(now - this.#lastCall) > longestSilence) this.reset();
    this.#lastCall = now;
    if (now < this.#nextAsk) return false;
    this.#asked += 1;
    this.#unanswered ??= now;
    this.#nextAsk = now + (this.#asked < eager.asks ? eager.every : every);
    return true;
  }

  /** Adds an answer: requested at `sent` and received at `now` by this clock, answered at `there` by the other one. */
  receive(sent: number, there: number, now: number): void {
    const roundTrip = now - sent;
    if (!(roundTrip >= 0 && roundTrip < longestSilence) || sent < this.#askedFrom) return;
    this.#unanswered = null;
    this.#trips = [...this.#trips.slice(-4), roundTrip];
    const newest = { receivedAt: now, offset: there - (sent + now) / 2, roundTrip };
    this.#answers = [...this.#answers.filter(({ receivedAt }) => now - receivedAt < memory), newest];
    this.#best = this.#answers.reduce((least, answer) => (answer.roundTrip < least.roundTrip ? answer : least));
    // No answer is wrong by more than half its round trip: a larger difference means that a clock was set or a
    // machine slept.
    if (Math.abs(newest.offset - this.#best.offset) > (roundTrip + this.#best.roundTrip) / 2 + 0.005) {
      this.#answers = [newest];
      this.#best = newest;
    }
  }

  /**
   * Returns the median round trip of the last five answers [s], or the age of an open request if that is longer; null:
   * no answer yet.
   */
  delayAt(now: number): number | null {
    const median = [...this.#trips].sort((a, b) => a - b)[Math.floor(this.#trips.length / 2)];
    if (median === undefined) return null;
    return Math.max(median, this.#unanswered === null ? 0 : now - this.#unanswered);
  }

  /** Adds a pause that this clock skipped [s] and that ended at `now` to the offset, until the next answer. */
  addPause(seconds: number, now: number): void {
    this.#best = { ...this.#best, offset: this.#best.offset + seconds };
    this.#askedFrom = now;
    this.reset();
  }

  /**
   * Discards all answers, because during a pause of the machine the clocks may have drifted apart. The offset stays
   * until the first new answer.
   */
  reset(): void {
    this.#unanswered = null;
    this.#answers = [];
    this.#asked = 0;
    this.#nextAsk = Number.NEGATIVE_INFINITY;
  }
}
