/** An exponential back-off with jitter. */
export interface BackOff {
  /** Failures since the last success. */
  readonly attempts: number;
  /** Counts a failure and returns the seconds until the next attempt. */
  next(): number;
  succeeded(): void;
}

const first = 0.5;
const longest = 3;

/**
 * Creates a back-off that doubles with every failure, up to 3 s, with a jitter of ±50 %: pages that lose a server at
 * the same moment do not all return at the same moment. `chance` returns numbers in [0, 1).
 */
export function createBackOff(chance: () => number = Math.random): BackOff {
  let attempts = 0;
  return {
    get attempts() {
      return attempts;
    },
    next() {
      const seconds = Math.min(longest, first * 2 ** attempts);
      attempts += 1;
      return seconds * (0.5 + chance());
    },
    succeeded() {
      attempts = 0;
    },
  };
}
