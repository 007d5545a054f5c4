import type { Socket } from 'socket.io';
import type { RelayContext } from '../relay-context';

/** A connection is too slow if it accepts no frame for this long [s], or if more packets than this wait. */
const slowSeconds = 5;
const maxWaiting = 256;
/** The most bytes that may wait on a connection that still receives poses: with TLS each write takes a moment. */
export const maxQueuedBytes = 4096;
const slowCheckMs = 1000;

interface Reader {
  /** The last time at which it accepted a frame [s]. */
  writableAt: number;
  /** The number of packets in its queue. */
  waiting: number;
}

/** Watches all open connections, and ends those whose client reads too slowly. */
export class SlowReaders {
  readonly #now: () => number;
  readonly #end: (conn: Socket['conn']) => void;
  readonly #readers = new Map<Socket['conn'], Reader>();
  readonly #timer: NodeJS.Timeout;

  constructor({ now, repeat }: RelayContext, end: (conn: Socket['conn']) => void) {
    this.#now = now;
    this.#end = end;
    this.#timer = repeat('the check of slow readers', slowCheckMs, () => this.#check());
  }

  watch(conn: Socket['conn']): void {
    const reader: Reader = { writableAt: this.#now(), waiting: 0 };
    this.#readers.set(conn, reader);
    conn.on('packetCreate', () => {
      reader.waiting += 1;
    });
    conn.on('flush', () => {
      reader.waiting = 0;
    });
    conn.once('close', () => this.#readers.delete(conn));
  }

  stop(): void {
    clearInterval(this.#timer);
  }

  #check(): void {
    const now = this.#now();
    for (const [conn, reader] of this.#readers) {
      const isFree = conn.transport.writable && conn.request.socket.writableLength <= maxQueuedBytes;
      if (isFree) reader.writableAt = now;
      if ((isFree || now - reader.writableAt <= slowSeconds) && reader.waiting <= maxWaiting) continue;
      this.#readers.delete(conn);
      this.#end(conn);
    }
  }
}
