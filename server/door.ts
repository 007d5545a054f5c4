import type { Socket } from 'node:net';

/** How many connections are open, of whom, and whether there is room for one more. */
export interface Door {
  /** Every connection that is open, silent ones included. */
  readonly open: number;
  /** Connections that were refused because their address had too many, since the start. */
  readonly refused: number;
  /** Counts a connection for as long as it is open; beyond the limit of its address it is ended at once, and false returned. */
  admit(socket: Socket): boolean;
}

export interface DoorOptions {
  /** Connections that one address may have open. */
  readonly perAddress: number;
  /** Addresses are those of a proxy, which limits its own clients: nothing is refused here. */
  readonly behindProxy: boolean;
}

/** Counts of something by name; names without any are forgotten. */
export function createTally(most: number): { take(name: string): boolean; give(name: string): void } {
  const counts = new Map<string, number>();
  return {
    take(name) {
      const count = counts.get(name) ?? 0;
      if (count >= most) return false;
      counts.set(name, count + 1);
      return true;
    },
    give(name) {
      const count = (counts.get(name) ?? 0) - 1;
      if (count > 0) counts.set(name, count);
      else counts.delete(name);
    },
  };
}

/** Keeps one address from taking all the room there is. */
export function createDoor({ perAddress, behindProxy }: DoorOptions): Door {
  const addresses = createTally(behindProxy ? Number.POSITIVE_INFINITY : perAddress);
  let open = 0;
  let refused = 0;
  return {
    get open() {
      return open;
    },
    get refused() {
      return refused;
    },
    admit(socket) {
      const address = socket.remoteAddress;
      // A connection that its client has ended before it was taken has no address any more.
      if (address === undefined || !addresses.take(address)) {
        if (address !== undefined) refused += 1;
        socket.on('error', () => undefined).destroy();
        return false;
      }
      open += 1;
      socket.once('close', () => {
        open -= 1;
        addresses.give(address);
      });
      return true;
    },
  };
}
