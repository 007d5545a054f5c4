import type { Socket } from 'node:net';
import { parseClientAddress } from './client-address';

interface ConnectionLimiterOptions {
  /** Open connections allowed for one address. */
  readonly perAddress: number;
  /** Whether connections come from a proxy, which limits its clients itself; then none is refused here. */
  readonly behindProxy: boolean;
}

/** Creates a counter of slots in use, `most` for each key. */
export function createSlotCounter(most: number): { acquire(key: string): boolean; release(key: string): void } {
  const counts = new Map<string, number>();
  return {
    acquire(key) {
      const count = counts.get(key) ?? 0;
      if (count >= most) return false;
      counts.set(key, count + 1);
      return true;
    },
    release(key) {
      const count = (counts.get(key) ?? 0) - 1;
      if (count > 0) counts.set(key, count);
      else counts.delete(key);
    },
  };
}

/** Counts the open connections, and limits those of one address. */
export class ConnectionLimiter {
  readonly #addresses: ReturnType<typeof createSlotCounter>;
  #open = 0;
  #refused = 0;

  constructor({ perAddress, behindProxy }: ConnectionLimiterOptions) {
    this.#addresses = createSlotCounter(behindProxy ? Number.POSITIVE_INFINITY : perAddress);
  }

  /** Open connections, silent ones included. */
  get open(): number {
    return this.#open;
  }

  /** Connections refused since the start because their address had too many. */
  get refused(): number {
    return this.#refused;
  }

  /** Counts a connection until it closes. Destroys it and returns false where its address has reached the limit. */
  admit(socket: Socket): boolean {
    // A connection that was closed before it was accepted has no address.
    const network = parseClientAddress(socket.remoteAddress ?? '')?.network;
    if (network === undefined || !this.#addresses.acquire(network)) {
      if (network !== undefined) this.#refused += 1;
      socket.on('error', () => undefined).destroy();
      return false;
    }
    this.#open += 1;
    socket.once('close', () => {
      this.#open -= 1;
      this.#addresses.release(network);
    });
    return true;
  }
}
