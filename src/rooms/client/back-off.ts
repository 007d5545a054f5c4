const first = 0.5;
const longest = 3;

/**
 * A back-off that doubles with every failure, up to 3 s, with a jitter of ±50 %: pages that lose a server at the same
 * moment do not all return at the same moment. `chance` returns numbers in [0, 1).
 */
export class BackOff {
  readonly #chance: () => number;
  #attempts = 0;

  constructor(chance: () => number = Math.random) {
    this.#chance = chance;
  }

  /** Failures since the last success. */
  get attempts(): number {
    return this.#attempts;
  }

  /** Counts a failure and returns the seconds until the next attempt. */
  next(): number {
    const seconds = Math.min(longest, first * 2 ** this.#attempts);
    this.#attempts += 1;
    return seconds * (0.5 + this.#chance());
  }

  reset(): void {
    this.#attempts = 0;
  }
}
