import type { Logger } from 'pino';
import { type ClientMessage, clientMessageFrom, protocolVersion } from '../protocol/messages';
import type { TokenBucket } from '../room/token-bucket';
import { dismiss, type Guest } from './guest';
import type { HostedRooms } from './hosted-rooms';
import type { RelayMetrics } from './relay-metrics';

export interface GuestMessagesOptions {
  readonly rooms: HostedRooms;
  readonly log: Logger;
  readonly metrics: RelayMetrics;
  /** Seconds, monotonic. */
  readonly now: () => number;
}

const badMessagesAllowed = 3;
/** More refused messages in a row than this count as an attack. */
const mostRefusedInARow = 60;

/** A guest who would join with another version of the protocol: a page from before an update, left open. */
const isOtherVersion = (value: unknown): boolean => {
  const { type, version } = (value ?? {}) as { type?: unknown; version?: unknown };
  return type === 'join' && typeof version === 'number' && version !== protocolVersion;
};

/** Signals between pages about their voices have a token bucket of their own. */
const isSignal = (value: unknown): boolean => ((value ?? {}) as { readonly type?: unknown }).type === 'signal';

/**
 * Passes the messages of guests to their rooms where they are well formed and within their limit. A guest that keeps sending anything else is
 * disconnected.
 */
export class GuestMessages {
  readonly #options: GuestMessagesOptions;

  constructor(options: GuestMessagesOptions) {
    this.#options = options;
  }

  onPose(guest: Guest, bytes: Uint8Array): void {
    const { rooms, metrics, now } = this.#options;
    const { counts } = metrics;
    counts.posesIn += 1;
    if (guest.ended) return;
    counts.bytesIn += bytes.length;
    const at = now();
    if (!this.#isWithin(guest, guest.poses, at)) {
      counts.posesIgnored += 1;
      return;
    }
    const hosted = rooms.get(guest.pass.room);
    const result = hosted?.room.onPose(guest.id, bytes, at);
    if (result === 'bad') this.#countBad(guest, 'pose');
    if (hosted && result === 'taken') rooms.sendPoses(hosted);
    else counts.posesIgnored += 1;
  }

  onMessage(guest: Guest, value: unknown): void {
    const { rooms, metrics, log, now } = this.#options;
    metrics.counts.messagesIn += 1;
    const at = now();
    if (guest.ended || !this.#isWithin(guest, isSignal(value) ? guest.signals : guest.events, at)) return;
    const message = clientMessageFrom(value);
    if (message?.type === 'join') this.#join(guest, message);
    else if (message) {
      const result = rooms.wake(guest.pass.room)?.room.onMessage(guest.id, message, at);
      if (result === 'bad') this.#countBad(guest, message.type);
    } else if (isOtherVersion(value)) {
      log.info({ room: guest.pass.room, client: guest.id }, 'page of another version');
      dismiss(guest, 'old-page');
    } else this.#countBad(guest, 'message');
  }

  /** The connection has ended. */
  onEnd({ id, pass }: Guest): void {
    const hosted = this.#options.rooms.wake(pass.room);
    hosted?.guests.delete(id);
    hosted?.room.disconnect(id, this.#options.now());
  }

  /** Ends the connection of a guest that harms others, at once. */
  kick(guest: Guest, reason: 'misbehaved' | 'slow', because: string): void {
    if (guest.ended) return;
    this.#options.metrics.kicked(because);
    this.#options.log.warn({ room: guest.pass.room, client: guest.id, because }, 'kicked');
    this.onEnd(guest);
    dismiss(guest, reason);
  }

  #join(guest: Guest, { type: _type, version: _version, ...asked }: ClientMessage & { type: 'join' }): void {
    if (guest.joined) {
      this.#countBad(guest, 'second join');
      return;
    }
    const hosted = this.#options.rooms.enter(guest.pass);
    if (!hosted) {
      this.kick(guest, 'misbehaved', 'rooms-full');
      return;
    }
    guest.joined = true;
    hosted.emptySince = null;
    hosted.guests.set(guest.id, guest);
    void guest.socket.join(guest.pass.room);
    const { identity, assigned } = guest.pass;
    // Where places are assigned, what the page asks for is not what it gets.
    const joining = assigned ? { ...asked, ...assigned, spectate: assigned.seat === null, bot: false } : asked;
    hosted.room.join(guest.id, identity, joining, this.#options.now());
  }

  /** Whether this message is still within what a client may send. */
  #isWithin(guest: Guest, bucket: TokenBucket, at: number): boolean {
    if (bucket.take(at)) return true;
    if (bucket.refusedInARow > mostRefusedInARow) this.kick(guest, 'misbehaved', 'budget');
    return false;
  }

  #countBad(guest: Guest, why: string): void {
    guest.badMessages += 1;
    this.#options.log.info({ room: guest.pass.room, client: guest.id, why }, 'bad message');
    if (guest.badMessages >= badMessagesAllowed) this.kick(guest, 'misbehaved', 'bad-messages');
  }
}
