/** When to try again after failing. */
export interface BackOff {
  /** Failures since the last success. */
  readonly attempts: number;
  /** Seconds until the next attempt. */
  next(): number;
  succeeded(): void;
}

const first = 0.5;
const longest = 3;

/**
 * Twice as long after every failure, at most 3 s, each time between half and one and a half of that by chance: pages that
 * lost a server at the same moment do not all come back to it at the same moment. `chance` gives numbers in [0, 1).
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
