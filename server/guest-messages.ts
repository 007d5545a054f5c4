import type { Logger } from 'pino';
import { type ClientMessage, clientMessageFrom, protocolVersion } from '../src/core/protocol/messages';
import type { Budget } from './budget';
import { dismiss, type Guest } from './guest';
import type { HostedRooms } from './hosted-rooms';
import type { RelayMetrics } from './relay-metrics';

/** What guests say, on its way to their rooms. */
export interface GuestMessages {
  pose(guest: Guest, bytes: unknown): void;
  message(guest: Guest, value: unknown): void;
  /** The connection has ended. */
  left(guest: Guest): void;
  /** Ends the connection of a guest that harms others, at once. */
  kick(guest: Guest, reason: 'misbehaved' | 'slow', because: string): void;
}

export interface GuestMessagesOptions {
  readonly rooms: HostedRooms;
  readonly log: Logger;
  readonly metrics: RelayMetrics;
  /** Seconds, monotonic. */
  readonly now: () => number;
}

const badMessagesAllowed = 3;
/** What a budget refused may be this much in a row before it counts as an attack. */
const mostOverdrawn = 60;

/** A guest who would join with another version of the protocol: a page from before an update, left open. */
const isOtherVersion = (value: unknown): boolean => {
  const { type, version } = (value ?? {}) as { type?: unknown; version?: unknown };
  return type === 'join' && typeof version === 'number' && version !== protocolVersion;
};

/** Lets through what is well formed and within its budget, and sends away who keeps sending anything else. */
export function createGuestMessages({ rooms, log, metrics, now }: GuestMessagesOptions): GuestMessages {
  const { counts } = metrics;

  function left({ id, pass }: Guest): void {
    const hosted = rooms.get(pass.room);
    hosted?.guests.delete(id);
    hosted?.room.disconnect(id, now());
  }

  function kick(guest: Guest, reason: 'misbehaved' | 'slow', because: string): void {
    if (guest.ended) return;
    metrics.kicked(because);
    log.warn({ room: guest.pass.room, client: guest.id, because }, 'kicked');
    left(guest);
    dismiss(guest, reason);
  }

  function bad(guest: Guest, why: string): void {
    guest.badMessages += 1;
    log.info({ room: guest.pass.room, client: guest.id, why }, 'bad message');
    if (guest.badMessages >= badMessagesAllowed) kick(guest, 'misbehaved', 'bad-messages');
  }

  /** Whether this message is still within what a client may send. */
  function within(guest: Guest, budget: Budget): boolean {
    const at = now();
    if (!guest.flood.spend(at)) {
      kick(guest, 'misbehaved', 'flood');
      return false;
    }
    if (budget.spend(at)) return true;
    if (budget.overdrawn > mostOverdrawn) kick(guest, 'misbehaved', 'budget');
    return false;
  }

  function join(guest: Guest, { type: _type, version: _version, ...asked }: ClientMessage & { type: 'join' }): void {
    if (guest.joined) {
      bad(guest, 'second join');
      return;
    }
    const hosted = rooms.enter(guest.pass);
    if (!hosted) {
      kick(guest, 'misbehaved', 'rooms-full');
      return;
    }
    guest.joined = true;
    hosted.emptySince = null;
    hosted.guests.set(guest.id, guest);
    void guest.socket.join(guest.pass.room);
    const { identity, assigned } = guest.pass;
    // Where places are assigned, what the page asks for is not what it gets.
    const joining = assigned ? { ...asked, ...assigned, spectate: assigned.seat === null, bot: false } : asked;
    hosted.room.join(guest.id, identity, joining, now());
  }

  return {
    left,
    kick,
    pose(guest, bytes) {
      counts.posesIn += 1;
      if (guest.ended) return;
      if (!(bytes instanceof Uint8Array)) {
        bad(guest, 'pose');
        return;
      }
      counts.bytesIn += bytes.length;
      if (!within(guest, guest.poses)) {
        counts.posesIgnored += 1;
        return;
      }
      const result = rooms.get(guest.pass.room)?.room.onPose(guest.id, bytes, now());
      if (result === 'bad') bad(guest, 'pose');
      if (result !== 'taken') counts.posesIgnored += 1;
    },
    message(guest, value) {
      counts.messagesIn += 1;
      if (guest.ended || !within(guest, guest.events)) return;
      const message = clientMessageFrom(value);
      if (message?.type === 'join') join(guest, message);
      else if (message) {
        if (rooms.get(guest.pass.room)?.room.onMessage(guest.id, message, now()) === 'bad') bad(guest, 'action');
      } else if (isOtherVersion(value)) {
        log.info({ room: guest.pass.room, client: guest.id }, 'page of another version');
        dismiss(guest, 'old-page');
      } else bad(guest, 'message');
    },
  };
}
