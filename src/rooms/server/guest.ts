import type { Socket as NetSocket } from 'node:net';
import type { Socket } from 'socket.io';
import type { Farewell, RoomMessage } from '../protocol/messages';
import { frameLength, writeFrame } from '../protocol/pose-frame';
import { messageEvent } from '../protocol/small-frames';
import type { HostedGame } from '../room/match-policy';
import type { FreshPose } from '../room/room-outlet';
import { TokenBucket } from '../room/token-bucket';
import type { RelayConfiguration } from './relay-configuration';
import type { RelayCounts } from './relay-metrics';
import { hangUp } from './relay-transport';
import type { RoomPass } from './room-tokens';
import { mostBytesWaiting } from './slow-readers';

/** A connection with a pass, before and after it joins its room. */
export interface Guest {
  readonly id: string;
  readonly socket: Socket;
  /** The connection below. */
  readonly wire: NetSocket;
  readonly pass: RoomPass;
  /** [s] */
  readonly connectedAt: number;
  readonly poses: TokenBucket;
  readonly events: TokenBucket;
  /** Of pages that set up their voices with each other. */
  readonly signals: TokenBucket;
  joined: boolean;
  badMessages: number;
  ended: boolean;
}

/** Two pages that connect need a dozen signals, and begin anew after a lost network; a page may have five others to connect to. */
const signalsPerSecond = 20;
const signalsAtOnce = 80;

/** `now`: seconds, monotonic. */
export const createGuest = (
  socket: Socket,
  { posesPerSecond, eventsPerSecond }: RelayConfiguration,
  now: number,
): Guest => ({
  id: socket.id,
  socket,
  wire: socket.conn.request.socket,
  pass: socket.data.pass,
  connectedAt: now,
  poses: new TokenBucket(posesPerSecond),
  events: new TokenBucket(eventsPerSecond, 2 * eventsPerSecond),
  signals: new TokenBucket(signalsPerSecond, signalsAtOnce),
  joined: false,
  badMessages: 0,
  ended: false,
});

export const tell = ({ socket }: Guest, message: RoomMessage<HostedGame>): void => {
  socket.emit(messageEvent, message);
};

/** Says farewell and ends the connection. */
export function dismiss(guest: Guest, reason: Farewell): void {
  if (guest.ended) return;
  guest.ended = true;
  tell(guest, { type: 'farewell', reason });
  hangUp(guest.socket);
}

/** The packets of all seats but one as a binary WebSocket message, unmasked, ready for the wire; null: there are none. */
function poseMessage(poses: readonly FreshPose[], except: number | null): Buffer | null {
  const length = frameLength(poses, except);
  if (length === 0) return null;
  const head = length < 126 ? 2 : 4;
  const message = Buffer.allocUnsafe(head + length);
  message[0] = 0x82;
  message[1] = Math.min(length, 126);
  if (head === 4) message.writeUInt16BE(length, 2);
  writeFrame(poses, except, message, head);
  return message;
}

/** The seat of the poses that came from this guest; null: none did. */
function seatAmong(poses: readonly FreshPose[], guest: string): number | null {
  for (const { from, seat } of poses) if (from === guest) return seat;
  return null;
}

/**
 * To all guests with a free connection, to each but their own; the others miss these. Straight to the wire: nothing of socket.io, Engine.IO
 * or ws lies between a message and it there, as none is compressed, and their queues cost as much as the system's call.
 */
export function sendPoses(to: Iterable<Guest>, poses: readonly FreshPose[], counts: RelayCounts): void {
  let shared: Buffer | null = null;
  for (const guest of to) {
    if (guest.ended) continue;
    const own = seatAmong(poses, guest.id);
    if (own === null) shared ??= poseMessage(poses, null);
    const message = own === null ? shared : poseMessage(poses, own);
    if (!message) continue;
    const { wire, socket } = guest;
    if (wire.writable && wire.writableLength <= mostBytesWaiting && socket.conn.readyState === 'open') {
      wire.write(message);
      counts.framesOut += 1;
      counts.bytesOut += message.length;
    } else counts.framesDropped += 1;
  }
}
