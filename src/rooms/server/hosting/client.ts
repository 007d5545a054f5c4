import type { Socket as NetSocket } from 'node:net';
import type { Socket } from 'socket.io';
import type { DisconnectReason, RoomMessage } from '../../protocol/messages';
import { frameLength, writeFrame } from '../../protocol/pose-frame';
import { messageEvent } from '../../protocol/socket-parsers';
import type { HostedGame } from '../../room/match-policy';
import type { FreshPose } from '../../room/room-host';
import { TokenBucket } from '../../room/token-bucket';
import type { PassClaims } from '../access/room-tokens';
import type { RelayConfiguration } from '../settings/relay-configuration';
import type { RelayCounts } from '../settings/relay-metrics';
import { closeConnection } from '../sockets/relay-transport';
import { maxQueuedBytes } from '../sockets/slow-readers';

/** A connection with a pass, before and after it joins its room. */
export interface Client {
  readonly id: string;
  readonly socket: Socket;
  /** The TCP socket of the connection. */
  readonly wire: NetSocket;
  readonly pass: PassClaims;
  /** Time of the connection [s]. */
  readonly connectedAt: number;
  readonly poses: TokenBucket;
  readonly events: TokenBucket;
  /** Limits the signals of the page's voice connections. */
  readonly signals: TokenBucket;
  joined: boolean;
  badMessages: number;
  ended: boolean;
}

/**
 * Limits of voice signals. Two pages need a dozen to connect, and again after an outage; a page connects to up to five
 * others.
 */
const signalsPerSecond = 20;
const signalsAtOnce = 80;

/** Creates the client of a socket whose pass is verified. `now`: seconds, monotonic. */
export const createClient = (
  socket: Socket,
  { posesPerSecond, eventsPerSecond }: RelayConfiguration,
  now: number,
): Client => ({
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

/** Sends a control message, reliably and in order. */
export const send = ({ socket }: Client, message: RoomMessage<HostedGame>): void => {
  socket.emit(messageEvent, message);
};

/** Sends the reason and closes the connection. */
export function disconnect(client: Client, reason: DisconnectReason): void {
  if (client.ended) return;
  client.ended = true;
  send(client, { type: 'farewell', reason });
  closeConnection(client.socket);
}

/** Returns the packets of all seats but one as an unmasked binary WebSocket frame; null: there are none. */
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

/** Returns the seat of a client's own poses among these; null: there are none of it. */
function seatAmong(poses: readonly FreshPose[], client: string): number | null {
  for (const { from, seat } of poses) if (from === client) return seat;
  return null;
}

/**
 * Sends poses to all clients, except each client's own; a client whose connection is busy misses them. Writes directly
 * to the TCP socket, because the queues of socket.io, Engine.IO and ws cost as much as the system call. Nothing is
 * compressed.
 */
export function sendPoses(to: Iterable<Client>, poses: readonly FreshPose[], counts: RelayCounts): void {
  let shared: Buffer | null = null;
  for (const client of to) {
    if (client.ended) continue;
    const own = seatAmong(poses, client.id);
    if (own === null) shared ??= poseMessage(poses, null);
    const message = own === null ? shared : poseMessage(poses, own);
    if (!message) continue;
    const { wire, socket } = client;
    if (wire.writable && wire.writableLength <= maxQueuedBytes && socket.conn.readyState === 'open') {
      wire.write(message);
      counts.framesOut += 1;
      counts.bytesOut += message.length;
    } else counts.framesDropped += 1;
  }
}
