import { TokenBucket } from './token-bucket';

/**
 * The most changes of a seat that are sent, per second on average and at once. Each costs every other page a fitted
 * body, a loaded file or a new voice connection.
 */
const changesPerSecond = 0.5;
const changesAtOnce = 8;

/**
 * Sends the state of seats that have changed: at once, or with a later tick if one changes too often. The last state is
 * always sent.
 */
export class SeatUpdates {
  readonly #send: (seat: number) => void;
  readonly #allowance: readonly TokenBucket[];
  /** Seats whose newest state is not sent yet. */
  readonly #unsent = new Set<number>();

  constructor(seats: number, send: (seat: number) => void) {
    this.#send = send;
    this.#allowance = Array.from({ length: seats }, () => new TokenBucket(changesPerSecond, changesAtOnce));
  }

  /** Whether all states are sent. */
  get isComplete(): boolean {
    return this.#unsent.size === 0;
  }

  changed(seat: number, time: number): void {
    this.#unsent.add(seat);
    this.#sendIfAllowed(seat, time);
  }

  tick(time: number): void {
    for (const seat of this.#unsent) this.#sendIfAllowed(seat, time);
  }

  #sendIfAllowed(seat: number, time: number): void {
    if (!this.#allowance[seat]?.take(time)) return;
    this.#unsent.delete(seat);
    this.#send(seat);
  }
}
