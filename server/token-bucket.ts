/** Limits how many messages of one kind a client may send. The count stays in this process, as it is read for every pose packet. */
export interface TokenBucket {
  /** Takes a token at this time [s, monotonic]; false where none is left. */
  take(now: number): boolean;
  /** How many calls have failed since the last one that succeeded. */
  readonly refusedInARow: number;
}

/** Returns a full bucket of `burst` tokens that gains `perSecond` tokens a second. */
export function createTokenBucket(perSecond: number, burst = perSecond): TokenBucket {
  let tokens = burst;
  let last: number | null = null;
  let refusedInARow = 0;
  return {
    get refusedInARow() {
      return refusedInARow;
    },
    take(now) {
      tokens = Math.min(burst, tokens + perSecond * Math.max(0, now - (last ?? now)));
      last = now;
      if (tokens < 1) {
        refusedInARow += 1;
        return false;
      }
      tokens -= 1;
      refusedInARow = 0;
      return true;
    },
  };
}
