import type { ParticipantSession } from './participant-session';
import type { After } from './study-page';

/** How often the device talks to the server, and how seldom when it does not answer [ms]. */
const exchangeEveryMs = 2000;
const slowestExchangeMs = 15_000;
/** How much longer the device waits after every silence of the server. */
const patience = 1.5;

type TimedSession = Pick<ParticipantSession, 'exchange' | 'motionSent' | 'uploadStatus'>;

/** Exchanges with the server at once when told, and by itself as long as the page is open: more seldom while there is no answer. */
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
   * Resolves when the exchange is over, whether the server answered or not, and no recording is on its way any more. The next exchange
   * does not wait for recordings.
   */
  async exchange(): Promise<void> {
    this.#callOff();
    await this.#session.exchange();
    const { online } = this.#session.uploadStatus;
    this.#delayMs = online ? exchangeEveryMs : Math.min(slowestExchangeMs, this.#delayMs * patience);
    // Another exchange may have ended meanwhile and have set its own time.
    this.#callOff();
    this.#callOff = this.#after(this.#delayMs, () => void this.exchange());
    await this.#session.motionSent();
  }
}
