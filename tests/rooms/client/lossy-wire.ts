import { type BallGame, ballClientPolicy } from 'threepoint-games/ball';
import type { ConnectionStatus, ConnectionUpdate } from '../../../src/rooms/client/connection';
import { RoomSession } from '../../../src/rooms/client/room-session';
import type { ClientMessage, RoomMessage } from '../../../src/rooms/protocol/messages';
import type { createTestRoom } from '../room/test-room';
import { visitor } from './people';

type Told = ReturnType<typeof createTestRoom>;

/** A person's connection to a room that a test controls, by default Ann's: it can be lost and come back. */
export class LossyWire extends RoomSession<BallGame> {
  readonly #told: Told;
  #connections: number;
  #heard = 0;
  #whole = false;
  readonly #person: string;

  /** before: connections of other pages. */
  constructor(told: Told, before = 0, { name, seat }: { name: string; seat: number } = { name: 'Ann', seat: 0 }) {
    super(ballClientPolicy, visitor(name, { seat }), true);
    this.#told = told;
    this.#person = name.toLowerCase();
    this.#connections = before;
    this.connect();
  }

  connect(): void {
    this.#connections += 1;
    this.#heard = this.#told.sent.length;
    this.#whole = true;
    this.#told.room.join(this.#name, this.#person, this.joinRequest(), this.#told.time);
  }

  lose(): void {
    this.#whole = false;
    this.#told.room.disconnect(this.#name, this.#told.time);
  }

  override get status(): ConnectionStatus {
    return { phase: this.#whole ? 'joined' : 'reconnecting', attempt: 0, retryIn: null, reason: null };
  }

  override update(time: number): ConnectionUpdate<BallGame> {
    const fresh = this.#whole ? this.#told.sent.slice(this.#heard) : [];
    this.#heard = this.#told.sent.length;
    for (const { to, message } of fresh) {
      if (to === 'all' || to === this.#name) this.onMessage(message as RoomMessage<BallGame>, time);
    }
    return this.takeUpdate(time, this.#whole);
  }

  override leave(): void {
    this.transmit({ type: 'leave' });
  }

  protected override transmit(message: ClientMessage): void {
    if (this.#whole && message.type !== 'join') this.#told.room.onMessage(this.#name, message, this.#told.time);
  }

  protected override transmitPose(bytes: Uint8Array): void {
    if (this.#whole) this.#told.room.onPose(this.#name, bytes, this.#told.time);
  }

  get #name(): string {
    return `${this.#person} ${this.#connections}`;
  }
}
