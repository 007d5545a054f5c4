import type { Socket } from 'socket.io';
import type { Farewell, RoomMessage } from '../src/core/protocol/messages';
import { messageEvent } from '../src/core/protocol/small-frames';
import type { HostedGame } from '../src/core/room/match-policy';
import { type Budget, createBudget } from './budget';
import type { RelayConfiguration } from './relay-configuration';
import type { RelayCounts } from './relay-metrics';
import { hangUp } from './relay-transport';
import type { RoomPass } from './room-tokens';

/** A connection with a pass, before and after it joins its room. */
export interface Guest {
  readonly id: string;
  readonly socket: Socket;
  readonly pass: RoomPass;
  /** [s] */
  readonly connectedAt: number;
  readonly poses: Budget;
  readonly events: Budget;
  /** Messages of any kind. */
  readonly flood: Budget;
  joined: boolean;
  badMessages: number;
  /** The last time that the connection could take a frame [s]. */
  writableAt: number;
  ended: boolean;
}

/** More than this many messages of any kind in a second is an attack. */
const floodPerSecond = 300;
/** A connection that could take no frame for this long [s], or has this many packets waiting, is too slow. */
const slowSeconds = 5;
const mostWaiting = 256;

/** `now`: seconds, monotonic. */
export const createGuest = (
  socket: Socket,
  { posesPerSecond, eventsPerSecond }: RelayConfiguration,
  now: number,
): Guest => ({
  id: socket.id,
  socket,
  pass: socket.data.pass,
  connectedAt: now,
  poses: createBudget(posesPerSecond),
  events: createBudget(eventsPerSecond, 2 * eventsPerSecond),
  flood: createBudget(floodPerSecond),
  joined: false,
  badMessages: 0,
  writableAt: now,
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

/** Packets that wait for the connection to take them. */
const packetsWaiting = (conn: Socket['conn']): number =>
  // reason: private in the types, yet the only count there is: the socket's own buffer shows 16 KiB at most.
  (conn as unknown as { readonly writeBuffer: readonly unknown[] }).writeBuffer.length;

/** Whether this guest reads too slowly to take part; asked again and again, `now` in seconds. */
export function isSlow(guest: Guest, now: number): boolean {
  const { conn } = guest.socket;
  if (conn.transport.writable) guest.writableAt = now;
  return now - guest.writableAt > slowSeconds || packetsWaiting(conn) > mostWaiting;
}

/** The bytes as one unmasked binary WebSocket frame, so that it is made once for a whole room. */
function webSocketFrame(bytes: Uint8Array): Buffer {
  const short = bytes.length < 126;
  const frame = Buffer.allocUnsafe((short ? 2 : 4) + bytes.length);
  frame[0] = 0x82;
  frame[1] = short ? bytes.length : 126;
  if (!short) frame.writeUInt16BE(bytes.length, 2);
  frame.set(bytes, short ? 2 : 4);
  return frame;
}

/** To all guests with a free connection; the others miss this one. `now`: [s] */
export function sendFrame(to: Iterable<Guest>, bytes: Uint8Array, now: number, counts: RelayCounts): void {
  const payload = Buffer.from(bytes.buffer, bytes.byteOffset, bytes.length);
  const sending = { compress: false, wsPreEncodedFrame: [webSocketFrame(bytes)] };
  for (const guest of to) {
    if (guest.ended) continue;
    const { conn } = guest.socket;
    if (conn.transport.writable) {
      guest.writableAt = now;
      conn.write(payload, sending);
      counts.framesOut += 1;
      counts.bytesOut += bytes.length;
    } else {
      counts.framesDropped += 1;
    }
  }
}
