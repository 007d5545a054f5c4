import type { ParticipantSession } from './session/participant-session';
import type { After } from './study-page';

/** The usual and the longest interval between two exchanges with the server [ms]. */
const exchangeEveryMs = 2000;
const slowestExchangeMs = 15_000;
/** The factor by which the interval grows after every exchange without an answer. */
const backOffFactor = 1.5;

type TimedSession = Pick<ParticipantSession, 'exchange' | 'motionSent' | 'uploadStatus'>;

/**
 * Exchanges with the server on request and periodically while the page is open, less often while there is no answer.
 */
export class ExchangeTimer {
  readonly #session: TimedSession;
  readonly #after: After;
  #delayMs = exchangeEveryMs;
  #callOff: () => void = () => undefined;

  constructor(session: TimedSession, after: After) {
    this.#session = session;
    this.#after = after;
  }

  /**
   * Resolves when the exchange is over, whether the server answered or not, and no upload of a recording is under way.
   * The next exchange does not wait for uploads.
   */
  async exchange(): Promise<void> {
    this.#callOff();
    await this.#session.exchange();
    const { online } = this.#session.uploadStatus;
    this.#delayMs = online ? exchangeEveryMs : Math.min(slowestExchangeMs, this.#delayMs * backOffFactor);
    // Another exchange may have ended in the meantime and have set its own timer.
    this.#callOff();
    this.#callOff = this.#after(this.#delayMs, () => void this.exchange());
    await this.#session.motionSent();
  }
}
