import { TokenBucket } from './token-bucket';

/**
 * Changes of a seat that others are sent: on average a second, and at once. Each costs every other page the fitting of a body, the loading of a
 * file or a new connection for voices.
 */
const changesPerSecond = 0.5;
const changesAtOnce = 8;

/** Sends how a seat is now when it has changed: at once, or with a later tick where it has changed too often. Nothing of its last state is lost. */
export class SeatUpdates {
  readonly #send: (seat: number) => void;
  readonly #allowance: readonly TokenBucket[];
  /** Seats of which others know an older state. */
  readonly #late = new Set<number>();

  constructor(seats: number, send: (seat: number) => void) {
    this.#send = send;
    this.#allowance = Array.from({ length: seats }, () => new TokenBucket(changesPerSecond, changesAtOnce));
  }

  /** Every other page knows all seats as they are. */
  get isComplete(): boolean {
    return this.#late.size === 0;
  }

  changed(seat: number, time: number): void {
    this.#late.add(seat);
    this.#sendIfAllowed(seat, time);
  }

  tick(time: number): void {
    for (const seat of this.#late) this.#sendIfAllowed(seat, time);
  }

  #sendIfAllowed(seat: number, time: number): void {
    if (!this.#allowance[seat]?.take(time)) return;
    this.#late.delete(seat);
    this.#send(seat);
  }
}
