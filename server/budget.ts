/** How many messages of one sort a client may still send. Counted in this process alone, as it is asked for every pose packet. */
export interface Budget {
  /** Whether one more is within the budget at this time [s, monotonic]. */
  spend(now: number): boolean;
  /** Since the last one that was within it. */
  readonly overdrawn: number;
}

/** `perSecond` on average, and up to `burst` at once. */
export function createBudget(perSecond: number, burst = perSecond): Budget {
  let left = burst;
  let last: number | null = null;
  let overdrawn = 0;
  return {
    get overdrawn() {
      return overdrawn;
    },
    spend(now) {
      left = Math.min(burst, left + perSecond * Math.max(0, now - (last ?? now)));
      last = now;
      if (left < 1) {
        overdrawn += 1;
        return false;
      }
      left -= 1;
      overdrawn = 0;
      return true;
    },
  };
}
