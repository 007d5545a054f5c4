import type { Socket } from 'socket.io';

/** A connection that could take no frame for this long [s], or has this many packets waiting, is too slow, with a pass or without. */
const slowSeconds = 5;
const mostWaiting = 256;
/** A connection may have so many bytes waiting and still be sent poses: one that encrypts takes a moment for each write. */
export const mostBytesWaiting = 4096;
/** Connections that read too slowly are looked for this often [ms]. */
const slowCheckMs = 1000;

/** Packets that wait for the connection to take them. */
const packetsWaiting = (conn: Socket['conn']): number =>
  // reason: private in the types, yet the only count there is: the socket's own buffer shows 16 KiB at most.
  (conn as unknown as { readonly writeBuffer: readonly unknown[] }).writeBuffer.length;

/** Watches all open connections, and ends those whose other side reads too slowly. */
export class SlowReaders {
  readonly #now: () => number;
  readonly #end: (conn: Socket['conn']) => void;
  /** The last time that each could take a frame [s]. */
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
      const isFree = conn.transport.writable && conn.request.socket.writableLength <= mostBytesWaiting;
      if (isFree) this.#writableAt.set(conn, now);
      if ((isFree || now - writableAt <= slowSeconds) && packetsWaiting(conn) <= mostWaiting) continue;
      this.#writableAt.delete(conn);
      this.#end(conn);
    }
  }
}
