/** Estimates the offset of another clock from timed requests. */
export interface ClockSync {
  /** The other clock minus this one [s]; 0 before the first answer. */
  readonly offset: number;
  /** Round trip of the answer from which `offset` is taken [s]; Infinity before the first. */
  readonly roundTrip: number;
  /**
   * Returns the median round trip of the last five answers [s], or the age of an open request if that is longer; null:
   * no answer yet.
   */
  delayAt(now: number): number | null;
  /** Returns whether to send a request now: often at first, then every two seconds. */
  due(now: number): boolean;
  /** Adds an answer: requested at `sent` and received at `now` by this clock, answered at `there` by the other one. */
  receive(sent: number, there: number, now: number): void;
  /** Adds a pause that this clock skipped [s] and that ended at `now` to the offset, until the next answer. */
  paused(seconds: number, now: number): void;
  /** Discards all answers: during a pause of the machine the clocks may have drifted apart. */
  reset(): void;
}

/** Answers older than this [s] are discarded, because clocks drift. */
const memory = 30;
const eager = { asks: 5, every: 0.2 } as const;
const every = 2;
/** After this long without an answer, or between two calls [s], the estimate is reset. */
const longestSilence = 5;

/**
 * Creates a clock estimate from the answer with the shortest round trip, half of which bounds its error. Clocks in
 * seconds, monotonic; a gap of more than 5 s between two calls of `due` counts as a pause of the machine.
 */
export function createClockSync(): ClockSync {
  let answers: { readonly at: number; readonly ahead: number; readonly roundTrip: number }[] = [];
  let trips: readonly number[] = [];
  /** The time of the oldest open request. */
  let unanswered: number | null = null;
  let asked = 0;
  let nextAsk = Number.NEGATIVE_INFINITY;
  let lastCall: number | null = null;
  /** Answers to requests from before a pause are ignored. */
  let askedFrom = Number.NEGATIVE_INFINITY;
  let best: { readonly ahead: number; readonly roundTrip: number } = {
    ahead: 0,
    roundTrip: Number.POSITIVE_INFINITY,
  };

  function reset(): void {
    unanswered = null;
    // `best` stays in use until the first new answer.
    answers = [];
    asked = 0;
    nextAsk = Number.NEGATIVE_INFINITY;
  }

  return {
    get offset() {
      return best.ahead;
    },
    get roundTrip() {
      return best.roundTrip;
    },
    due(now) {
      if (lastCall !== null && Math.abs(now - lastCall) > longestSilence) reset();
      lastCall = now;
      if (now < nextAsk) return false;
      asked += 1;
      unanswered ??= now;
      nextAsk = now + (asked < eager.asks ? eager.every : every);
      return true;
    },
    receive(sent, there, now) {
      const roundTrip = now - sent;
      if (!(roundTrip >= 0 && roundTrip < longestSilence) || sent < askedFrom) return;
      unanswered = null;
      trips = [...trips.slice(-4), roundTrip];
      answers = answers.filter(({ at }) => now - at < memory);
      answers.push({ at: now, ahead: there - (sent + now) / 2, roundTrip });
      best = answers.reduce((least, answer) => (answer.roundTrip < least.roundTrip ? answer : least));
      // No answer is wrong by more than half its round trip: a larger difference means that a clock was set or a
      // machine slept.
      const newest = answers[answers.length - 1]!;
      if (Math.abs(newest.ahead - best.ahead) > (newest.roundTrip + best.roundTrip) / 2 + 0.005) {
        answers = [newest];
        best = newest;
      }
    },
    delayAt(now) {
      const median = [...trips].sort((a, b) => a - b)[Math.floor(trips.length / 2)];
      if (median === undefined) return null;
      return Math.max(median, unanswered === null ? 0 : now - unanswered);
    },
    paused(seconds, now) {
      best = { ...best, ahead: best.ahead + seconds };
      askedFrom = now;
      reset();
    },
    reset,
  };
}
