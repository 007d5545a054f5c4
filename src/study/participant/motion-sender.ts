import { ServerRefusal, ServerUnreachable } from '../client/study-client';
import type { SessionStore } from './session-store';

/** After recordings that did not arrive so many exchanges pass at most before they are sent again: each may be 16 MiB. */
const longestRest = 32;

export interface MotionSenderOptions {
  readonly send: (trial: string, recording: string) => Promise<void>;
  /** Told of what is neither a refusal of one recording nor a silence of the server. */
  readonly onFault: (error: unknown) => void;
  readonly onChange: () => void;
}

/** Sends the recordings of a session one after the other, beside its exchanges: one may take minutes, and no command waits for it. */
export class MotionSender {
  readonly #store: SessionStore;
  readonly #options: MotionSenderOptions;
  #sending: Promise<void> | null = null;
  #refusal: string | null = null;
  /** Exchanges left out before the next attempt, and after it, should it fail too. */
  #rest = 0;
  #nextRest = 1;

  constructor(store: SessionStore, options: MotionSenderOptions) {
    this.#store = store;
    this.#options = options;
  }

  /** Why the server refuses a recording, however often it is sent; null: it refuses none. */
  get refusal(): string | null {
    return this.#refusal;
  }

  /** Begins to send what is kept, unless that is under way or has failed a moment ago. Asked with every exchange. */
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

  /** Resolves when no recording is on its way; never rejects. */
  sent(): Promise<void> {
    return this.#sending ?? Promise.resolve();
  }

  /** What the server will not take stays and does not hold up the rest. */
  async #sendAll(): Promise<void> {
    let refusal: string | null = null;
    try {
      for (const { trial, recording } of this.#store.motion) {
        refusal = (await this.#sendOrRefuse(trial, recording)) ?? refusal;
      }
      this.#restAfter(refusal !== null);
    } catch (error) {
      this.#restAfter(true);
      if (!(error instanceof ServerUnreachable)) this.#options.onFault(error);
    }
    this.#refusal = refusal;
  }

  async #sendOrRefuse(trial: string, recording: string): Promise<string | null> {
    try {
      await this.#options.send(trial, recording);
    } catch (error) {
      if (!(error instanceof ServerRefusal) || error.status === 401) throw error;
      return error.message;
    }
    await this.#store.acknowledgeMotion(trial);
    return null;
  }

  #restAfter(failed: boolean): void {
    this.#rest = failed ? this.#nextRest : 0;
    this.#nextRest = failed ? Math.min(longestRest, 2 * this.#nextRest) : 1;
  }
}
