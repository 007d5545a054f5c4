import type { ClientMessage, DisconnectReason } from '../protocol/messages';
import { encodeFrame } from '../protocol/pose-frame';
import type { HostedGame, MatchAction, MatchPolicy } from '../room/match-policy';
import { Room, type RoomOptions } from '../room/room';
import type { ClientId, RoomRejection } from '../room/room-host';
import type { ClientPolicy } from './client-policy';
import type { Connection, ConnectionStatus, ConnectionUpdate, Visitor } from './connection';
import { RoomSession } from './room-session';

export interface LoopbackOptions<Game extends HostedGame> extends Partial<RoomOptions> {
  rejected?(rejection: RoomRejection): void;
  stepped?(actions: readonly MatchAction<Game>[]): void;
}

/**
 * A host of the same Room class as the server's in this page, for a single player with bots, and for tests; it may be
 * paused. It ticks with the first `update` of a frame.
 */
export class LoopbackHost<Game extends HostedGame> {
  readonly room: Room<Game>;
  readonly policy: ClientPolicy<Game>;
  readonly #connections = new Map<ClientId, LoopbackConnection<Game>>();
  #now = 0;
  #ticked = Number.NEGATIVE_INFINITY;
  #count = 0;

  constructor(
    match: MatchPolicy<Game>,
    client: ClientPolicy<Game>,
    { rejected, stepped, ...options }: LoopbackOptions<Game> = {},
  ) {
    this.policy = client;
    this.room = new Room<Game>(
      match,
      { id: 'here', epoch: 'here', pausable: true, ...options },
      {
        send: (to, message) => this.#connections.get(to)?.onMessage(message, this.#now),
        broadcast: (message) => {
          for (const connection of this.#connections.values()) connection.onMessage(message, this.#now);
        },
        sendPoses: (poses) => {
          const frame = encodeFrame(poses);
          for (const connection of this.#connections.values()) connection.onFrame(frame, this.#now);
        },
        disconnect: (client, reason) => {
          this.#connections.get(client)?.end(reason);
          this.#connections.delete(client);
        },
        rejected: (rejection) => rejected?.(rejection),
        ...(stepped && { stepped }),
      },
    );
  }

  get now(): number {
    return this.#now;
  }

  /** Joins the room. `time`: the page's clock [s]. */
  connect(visitor: Visitor, time: number): Connection<Game> {
    this.#now = Math.max(this.#now, time);
    this.#count += 1;
    const client = `client ${this.#count}`;
    const connection = new LoopbackConnection(this, client, visitor);
    this.#connections.set(client, connection);
    connection.join();
    return connection;
  }

  /** Ticks the room at this time of the page's clock [s]. */
  advance(time: number): void {
    this.#now = Math.max(this.#now, time);
    if (this.#now <= this.#ticked) return;
    this.#ticked = this.#now;
    this.room.tick(this.#now);
    this.room.sendPoses();
  }
}

class LoopbackConnection<Game extends HostedGame> extends RoomSession<Game> {
  readonly #shared: LoopbackHost<Game>;
  readonly #client: ClientId;
  #status: ConnectionStatus = { phase: 'joined', attempt: 0, retryIn: null, reason: null };

  constructor(shared: LoopbackHost<Game>, client: ClientId, visitor: Visitor) {
    super(shared.policy, visitor, true);
    this.#shared = shared;
    this.#client = client;
  }

  get status(): ConnectionStatus {
    return this.#status;
  }

  join(): void {
    this.#shared.room.join(this.#client, this.#client, this.joinRequest(), this.#shared.now);
  }

  end(reason: DisconnectReason): void {
    this.#status = { phase: 'ended', attempt: 0, retryIn: null, reason };
  }

  update(time: number): ConnectionUpdate<Game> {
    this.#shared.advance(time);
    return this.takeUpdate(this.#shared.now, this.#isHere);
  }

  leave(): void {
    this.transmit({ type: 'leave' });
  }

  protected transmit(message: ClientMessage): void {
    if (this.#isHere && message.type !== 'join') this.#shared.room.onMessage(this.#client, message, this.#shared.now);
  }

  protected transmitPose(bytes: Uint8Array): void {
    if (this.#isHere) this.#shared.room.onPose(this.#client, bytes, this.#shared.now);
  }

  get #isHere(): boolean {
    return this.#status.phase === 'joined';
  }
}
