import type { VoiceSettings } from './voice-settings';

/** Of the time that a pass is good for, the share after which another one is asked for. */
const renewedAfter = 0.75;
/** Where the server does not answer, it is asked again after so long [ms]. */
const againMs = 15_000;

/** What a server says of the voices in a room. The pass to its relay expires: it is asked for anew before. */
export class IceServerCache {
  readonly #ask: () => Promise<VoiceSettings>;
  readonly #now: () => number;
  #newest: VoiceSettings | null = null;
  /** When the server is to be asked next [ms of `now`]. */
  #due = Number.POSITIVE_INFINITY;
  #asking = false;

  /** `now`: a clock [ms] that goes on while the device sleeps. */
  constructor(ask: () => Promise<VoiceSettings>, now: () => number = Date.now) {
    this.#ask = ask;
    this.#now = now;
  }

  /** null: the server has not said yet. */
  get newest(): VoiceSettings | null {
    return this.#newest;
  }

  /** Asks now. Rejects where the server does not say; what it said last stays. */
  async refresh(): Promise<VoiceSettings> {
    const asked = this.#now();
    const terms = await this.#ask();
    this.#newest = terms;
    this.#due = terms.ttlSeconds === null ? Number.POSITIVE_INFINITY : asked + 1000 * renewedAfter * terms.ttlSeconds;
    return terms;
  }

  /** To be called often: asks when it is time to. Resolves to what is new, or null: nothing is. Never rejects. */
  async refreshIfDue(): Promise<VoiceSettings | null> {
    if (this.#asking || this.#now() < this.#due) return null;
    this.#asking = true;
    this.#due = this.#now() + againMs;
    const renewed = await this.refresh().catch(() => null);
    this.#asking = false;
    return renewed;
  }
}
