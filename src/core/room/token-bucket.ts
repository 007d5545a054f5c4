/** A limit on how often something happens: `burst` times at once, and `perSecond` on average. Times are in seconds and never go back. */
export class TokenBucket {
  readonly #perSecond: number;
  readonly #burst: number;
  #tokens: number;
  #filledAt: number | null = null;

  constructor(perSecond: number, burst: number) {
    this.#perSecond = perSecond;
    this.#burst = burst;
    this.#tokens = burst;
  }

  /** Takes a token at this time; false: there is none. */
  take(time: number): boolean {
    this.#fill(time);
    if (this.#tokens < 1) return false;
    this.#tokens -= 1;
    return true;
  }

  #fill(time: number): void {
    this.#tokens = Math.min(this.#burst, this.#tokens + this.#perSecond * (time - (this.#filledAt ?? time)));
    this.#filledAt = time;
  }
}
