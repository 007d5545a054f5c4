/**
 * Limits a rate: `burst` at once, and `perSecond` on average. Times are in seconds; a time that goes back adds no
 * tokens.
 */
export class TokenBucket {
  readonly #perSecond: number;
  readonly #burst: number;
  #tokens: number;
  #filledAt: number | null = null;
  #rejectedInARow = 0;

  constructor(perSecond: number, burst = perSecond) {
    this.#perSecond = perSecond;
    this.#burst = burst;
    this.#tokens = burst;
  }

  /** The number of failed calls of `take` since the last success. */
  get rejectedInARow(): number {
    return this.#rejectedInARow;
  }

  /** Takes a token at this time; returns false if none is left. */
  take(time: number): boolean {
    const passed = Math.max(0, time - (this.#filledAt ?? time));
    this.#tokens = Math.min(this.#burst, this.#tokens + this.#perSecond * passed);
    this.#filledAt = time;
    if (this.#tokens < 1) {
      this.#rejectedInARow += 1;
      return false;
    }
    this.#tokens -= 1;
    this.#rejectedInARow = 0;
    return true;
  }
}
