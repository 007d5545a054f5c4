import type { VoiceSettings } from './voice-settings';

/** The settings are refreshed after this share of their time to live. */
const refreshShare = 0.75;
/** After a failed request the next one follows after this time [ms]. */
const retryMs = 15_000;

/** Caches the voice settings of a room, and refreshes them before the credential of its TURN server expires. */
export class IceServerCache {
  readonly #fetch: () => Promise<VoiceSettings>;
  readonly #now: () => number;
  #newest: VoiceSettings | null = null;
  /** Time of the next refresh [ms of `now`]. */
  #due = Number.POSITIVE_INFINITY;
  #isFetching = false;

  /** `now`: a clock [ms] that runs on while the device sleeps. */
  constructor(fetchSettings: () => Promise<VoiceSettings>, now: () => number = Date.now) {
    this.#fetch = fetchSettings;
    this.#now = now;
  }

  /** The newest settings; null before the first answer. */
  get newest(): VoiceSettings | null {
    return this.#newest;
  }

  /** Fetches the settings now. Rejects if the server does not answer; the last settings stay. */
  async refresh(): Promise<VoiceSettings> {
    const sentAt = this.#now();
    const settings = await this.#fetch();
    this.#newest = settings;
    this.#due =
      settings.ttlSeconds === null ? Number.POSITIVE_INFINITY : sentAt + 1000 * refreshShare * settings.ttlSeconds;
    return settings;
  }

  /** Fetches the settings if they are due; to be called often. Resolves to new settings, or to null. Never rejects. */
  async refreshIfDue(): Promise<VoiceSettings | null> {
    if (this.#isFetching || this.#now() < this.#due) return null;
    this.#isFetching = true;
    this.#due = this.#now() + retryMs;
    const renewed = await this.refresh().catch(() => null);
    this.#isFetching = false;
    return renewed;
  }
}
