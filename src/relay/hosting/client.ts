import type { Socket } from 'socket.io';
import { type DisconnectReason, encodeFrame, type FreshPose, messageEvent, TokenBucket } from 'threepoint-rooms/host';
import type { HostedGame, RoomMessage } from 'threepoint-rooms/room';
import type { PassClaims } from '../access/room-tokens';
import type { RelayConfiguration } from '../settings/relay-configuration';
import type { RelayCounts } from '../settings/relay-metrics';
import { closeConnection, type RelayTransport } from '../sockets/relay-transport';

/** A connection with a pass, before and after it joins its room. */
export interface Client {
  readonly id: string;
  readonly socket: Socket;
  /** Sends a frame of poses. Returns whether it was sent: a busy connection misses it. */
  readonly sendFrame: (frame: Uint8Array) => boolean;
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
  sendFrame: RelayTransport['sendFrame'],
  { posesPerSecond, eventsPerSecond }: RelayConfiguration,
  now: number,
): Client => ({
  id: socket.id,
  socket,
  sendFrame: (frame) => sendFrame(socket, frame),
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

/** Returns the seat of a client's own poses among these; null: there are none of it. */
function seatAmong(poses: readonly FreshPose[], client: string): number | null {
  for (const { from, seat } of poses) if (from === client) return seat;
  return null;
}

/** Sends poses to all clients, except each client's own; a client whose connection is busy misses them. */
export function sendPoses(to: Iterable<Client>, poses: readonly FreshPose[], counts: RelayCounts): void {
  let shared: Uint8Array | null = null;
  for (const client of to) {
    if (client.ended) continue;
    const own = seatAmong(poses, client.id);
    if (own === null) shared ??= encodeFrame(poses, null);
    const frame = own === null ? shared : encodeFrame(poses, own);
    if (!frame || frame.length === 0) continue;
    if (client.sendFrame(frame)) {
      counts.framesOut += 1;
      counts.bytesOut += frame.length;
    } else counts.framesDropped += 1;
  }
}
