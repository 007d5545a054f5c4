import { ServerUnreachable } from '../../client/study-client';
import { rejectionOf } from './send-records';
import type { SessionStore } from './session-store';

/** The most exchanges that pass before failed uploads are repeated. Each may be 16 MiB. */
const longestRest = 32;

export interface MotionSenderOptions {
  readonly send: (trial: string, recording: string) => Promise<void>;
  /** Called with an error that is neither a refusal of one recording nor a missing answer. */
  readonly onError: (error: unknown) => void;
  readonly onChange: () => void;
}

/**
 * Uploads the recordings of a session one after the other, in parallel to its exchanges: an upload may take minutes,
 * and commands do not wait for it.
 */
export class MotionSender {
  readonly #store: SessionStore;
  readonly #options: MotionSenderOptions;
  #sending: Promise<void> | null = null;
  #rejection: string | null = null;
  /** The number of exchanges to skip before the next attempt; it grows if that fails too. */
  #rest = 0;
  #nextRest = 1;

  constructor(store: SessionStore, options: MotionSenderOptions) {
    this.#store = store;
    this.#options = options;
  }

  /** Why the server refuses a recording permanently; null: it refuses none. */
  get rejection(): string | null {
    return this.#rejection;
  }

  /**
   * Starts to upload the kept recordings, unless an upload is under way or has just failed. Called with every exchange.
   */
  send(): void {
    if (this.#sending || this.#store.motion.length === 0) return;
    if (this.#rest > 0) {
      this.#rest -= 1;
      return;
    }
    this.#sending = this.#sendAll().finally(() => {
      this.#sending = null;
      this.#options.onChange();
    });
  }

  /** Resolves when no upload is under way; never rejects. */
  sent(): Promise<void> {
    return this.#sending ?? Promise.resolve();
  }

  /** A refused recording is kept and does not delay the others. */
  async #sendAll(): Promise<void> {
    let rejection: string | null = null;
    try {
      for (const { trial, recording } of this.#store.motion) {
        const rejected = await rejectionOf(async () => {
          await this.#options.send(trial, recording);
          await this.#store.acknowledgeMotion(trial);
        });
        rejection = rejected ?? rejection;
      }
      this.#restAfter(rejection !== null);
    } catch (error) {
      this.#restAfter(true);
      if (!(error instanceof ServerUnreachable)) this.#options.onError(error);
    }
    this.#rejection = rejection;
  }

  #restAfter(failed: boolean): void {
    this.#rest = failed ? this.#nextRest : 0;
    this.#nextRest = failed ? Math.min(longestRest, 2 * this.#nextRest) : 1;
  }
}
