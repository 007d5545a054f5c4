import { type ClientMessage, clientMessageFrom, protocolVersion, type TokenBucket } from 'threepoint-rooms/host';
import type { RelayContext } from '../relay-context';
import { type Client, disconnect } from './client';
import type { RoomRegistry } from './room-registry';

const badMessagesAllowed = 3;
/** The most messages in a row beyond the limit; more count as an attack. */
const maxRejectedInARow = 60;

/** Returns whether a message is a join with another protocol version, from a page that was loaded before an update. */
const isOtherVersion = (value: unknown): boolean => {
  const { type, version } = (value ?? {}) as { type?: unknown; version?: unknown };
  return type === 'join' && typeof version === 'number' && version !== protocolVersion;
};

/** Returns whether a message is a voice signal, which has its own token bucket. */
const isSignal = (value: unknown): boolean => ((value ?? {}) as { readonly type?: unknown }).type === 'signal';

/**
 * Passes the messages of clients to their rooms, if they are valid and within the limits. A client that keeps sending
 * other messages is disconnected.
 */
export class MessageHandler {
  readonly #rooms: RoomRegistry;
  readonly #context: RelayContext;

  constructor(rooms: RoomRegistry, context: RelayContext) {
    this.#rooms = rooms;
    this.#context = context;
  }

  onPose(client: Client, bytes: Uint8Array): void {
    const { metrics, now } = this.#context;
    const { counts } = metrics;
    counts.posesIn += 1;
    if (client.ended) return;
    counts.bytesIn += bytes.length;
    const at = now();
    if (!this.#isWithin(client, client.poses, at)) {
      counts.posesIgnored += 1;
      return;
    }
    const hosted = this.#rooms.get(client.pass.room);
    const result = hosted?.room.onPose(client.id, bytes, at);
    if (result === 'bad') this.#countBad(client, 'pose');
    if (hosted && result === 'taken') this.#rooms.sendPoses(hosted);
    else counts.posesIgnored += 1;
  }

  onMessage(client: Client, value: unknown): void {
    const { metrics, log, now } = this.#context;
    metrics.counts.messagesIn += 1;
    const at = now();
    if (client.ended || !this.#isWithin(client, isSignal(value) ? client.signals : client.events, at)) return;
    const message = clientMessageFrom(value);
    if (message?.type === 'join') this.#join(client, message);
    else if (message) {
      const result = this.#rooms.wake(client.pass.room)?.room.onMessage(client.id, message, at);
      if (result === 'bad') this.#countBad(client, message.type);
    } else if (isOtherVersion(value)) {
      log.info({ room: client.pass.room, client: client.id }, 'page of another version');
      disconnect(client, 'old-page');
    } else this.#countBad(client, 'message');
  }

  onDisconnect({ id, pass }: Client): void {
    const hosted = this.#rooms.wake(pass.room);
    hosted?.clients.delete(id);
    hosted?.room.disconnect(id, this.#context.now());
  }

  /** Disconnects a client that harms others or whose room cannot be opened. `because`: the label of the metric. */
  kick(client: Client, reason: 'misbehaved' | 'slow' | 'full', because: string): void {
    if (client.ended) return;
    this.#context.metrics.kicked(because);
    this.#context.log.warn({ room: client.pass.room, client: client.id, because }, 'kicked');
    this.onDisconnect(client);
    disconnect(client, reason);
  }

  #join(client: Client, { type: _type, version: _version, ...request }: ClientMessage & { type: 'join' }): void {
    if (client.joined) {
      this.#countBad(client, 'second join');
      return;
    }
    const hosted = this.#rooms.getOrCreate(client.pass);
    if (!hosted) {
      this.kick(client, 'full', 'rooms-full');
      return;
    }
    client.joined = true;
    hosted.emptySince = null;
    hosted.clients.set(client.id, client);
    void client.socket.join(client.pass.room);
    const { identity, assigned } = client.pass;
    // An assigned seat overrides the page's request.
    const joining = assigned ? { ...request, ...assigned, spectate: assigned.seat === null, bot: false } : request;
    hosted.room.join(client.id, identity, joining, this.#context.now());
  }

  /** Returns whether a message is within the client's limit. */
  #isWithin(client: Client, bucket: TokenBucket, at: number): boolean {
    if (bucket.take(at)) return true;
    if (bucket.rejectedInARow > maxRejectedInARow) this.kick(client, 'misbehaved', 'budget');
    return false;
  }

  #countBad(client: Client, why: string): void {
    client.badMessages += 1;
    this.#context.log.info({ room: client.pass.room, client: client.id, why }, 'bad message');
    if (client.badMessages >= badMessagesAllowed) this.kick(client, 'misbehaved', 'bad-messages');
  }
}
