/** What is known of another clock by asking it for the time. */
export interface ClockSync {
  /** The other clock minus ours [s]; 0 before the first answer. */
  readonly offset: number;
  /** Round trip of the answer that `ahead` is taken from [s]; Infinity before the first. */
  readonly roundTrip: number;
  /** Median round trip of the last five answers [s], as long as the newest has been waited for where that is longer; null: none yet. */
  delayAt(now: number): number | null;
  /** Whether to ask now: often at first, then every two seconds. */
  due(now: number): boolean;
  /** An answer: asked at `sent`, heard at `now` (ours), given at `there` (theirs). */
  receive(sent: number, there: number, now: number): void;
  /** Our clock left out `seconds` of a pause that ended at `now`: theirs is so much further ahead, until it is asked afresh. */
  paused(seconds: number, now: number): void;
  /** Forgets everything: after a pause of the machine clocks may have gone on differently. */
  reset(): void;
}

/** Answers older than this [s] count no more: clocks drift. */
const memory = 30;
const eager = { asks: 5, every: 0.2 } as const;
const every = 2;
/** No answer in this time [s], or a clock that went this far between two calls: start afresh. */
const longestSilence = 5;

/**
 * The answer with the shortest round trip tells best: half of it is the largest error it can have. Clocks in seconds, monotonic;
 * a gap of more than 5 s between two calls of `due` counts as a pause of the machine.
 */
export function createClockSync(): ClockSync {
  let answers: { readonly at: number; readonly ahead: number; readonly roundTrip: number }[] = [];
  let trips: readonly number[] = [];
  /** The oldest question that waits for its answer. */
  let unanswered: number | null = null;
  let asked = 0;
  let nextAsk = Number.NEGATIVE_INFINITY;
  let lastCall: number | null = null;
  /** Questions from before a pause are answered too late to tell anything. */
  let askedFrom = Number.NEGATIVE_INFINITY;
  let best: { readonly ahead: number; readonly roundTrip: number } = {
    ahead: 0,
    roundTrip: Number.POSITIVE_INFINITY,
  };

  function reset(): void {
    unanswered = null;
    // The old answer serves until the first new one.
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
      // A clock that was set, or a machine that slept: no answer can be wrong by more than half its round trip.
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
