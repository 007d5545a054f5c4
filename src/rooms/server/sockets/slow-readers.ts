import type { Socket } from 'socket.io';

/** A connection is too slow if it accepts no frame for this long [s], or if more packets than this wait. */
const slowSeconds = 5;
const maxWaiting = 256;
/** The most bytes that may wait on a connection that still receives poses: with TLS each write takes a moment. */
export const maxQueuedBytes = 4096;
/** Interval of the check [ms]. */
const slowCheckMs = 1000;

/** Returns the number of packets that wait in a connection's queue. */
const packetsWaiting = (conn: Socket['conn']): number =>
  // reason: private in the types, but the only count: the socket's own buffer holds 16 KiB at most.
  (conn as unknown as { readonly writeBuffer: readonly unknown[] }).writeBuffer.length;

/** Watches all open connections, and ends those whose client reads too slowly. */
export class SlowReaders {
  readonly #now: () => number;
  readonly #end: (conn: Socket['conn']) => void;
  /** The last time at which each accepted a frame [s]. */
  readonly #writableAt = new Map<Socket['conn'], number>();
  readonly #timer = setInterval(() => this.#check(), slowCheckMs);

  /** `now`: seconds, monotonic. */
  constructor(now: () => number, end: (conn: Socket['conn']) => void) {
    this.#now = now;
    this.#end = end;
  }

  watch(conn: Socket['conn']): void {
    this.#writableAt.set(conn, this.#now());
    conn.once('close', () => this.#writableAt.delete(conn));
  }

  stop(): void {
    clearInterval(this.#timer);
  }

  #check(): void {
    const now = this.#now();
    for (const [conn, writableAt] of this.#writableAt) {
      const isFree = conn.transport.writable && conn.request.socket.writableLength <= maxQueuedBytes;
      if (isFree) this.#writableAt.set(conn, now);
      if ((isFree || now - writableAt <= slowSeconds) && packetsWaiting(conn) <= maxWaiting) continue;
      this.#writableAt.delete(conn);
      this.#end(conn);
    }
  }
}
