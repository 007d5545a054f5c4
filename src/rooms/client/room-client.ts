import type { AvatarPose, Fingers, RemotePerson } from 'threepoint/core';
import { composeTransforms, identity, invertTransform, type Transform, zero } from 'threepoint/math';
import type { SeatInfo } from '../protocol/messages';
import type { HostedGame } from '../room/match-policy';
import type { Connection, ConnectionStatus, ConnectionUpdate, RoomView } from './connection';
import { RemotePlayers } from './remote-players';

const connecting: ConnectionStatus = { phase: 'connecting', attempt: 0, retryIn: null, reason: null };
const noSeats: readonly never[] = [];
const arenaIsFloor: Transform<'floor', 'arena'> = { position: zero, orientation: identity };

/**
 * A page's client of a room: holds the connection, plays back the other people, and sends the user's body. Times are on
 * the page's clock [s].
 *
 * @example
 * const client = new RoomClient(address.connect({ name: 'Ada', calibration }));
 * const { events } = client.update(time); // in each frame, before `people`
 * for (const { id, pose, placement } of client.people) draw(id, pose, placement);
 * client.sendPose(time, pose, fingers);
 */
export class RoomClient<Game extends HostedGame> {
  readonly #connect: (time: number) => Connection<Game>;
  #connection: Connection<Game> | null;
  readonly #players = new RemotePlayers();
  readonly #people: RemotePerson[] = [];
  /** The seats at the last update. */
  #seats: readonly (SeatInfo | null)[] = noSeats;
  #jump = false;
  #placedBy: Transform<'arena', 'floor'> | null = null;
  #floorFromArena = arenaIsFloor;

  /** `connection`: a connection, or a function that creates it at the first update. */
  constructor(connection: Connection<Game> | ((time: number) => Connection<Game>)) {
    this.#connect = typeof connection === 'function' ? connection : () => connection;
    this.#connection = typeof connection === 'function' ? null : connection;
  }

  /** The connection; null before the first update if a function creates it. */
  get connection(): Connection<Game> | null {
    return this.#connection;
  }

  get status(): ConnectionStatus {
    return this.#connection?.status ?? connecting;
  }

  /** The room as this page knows it; null before the first welcome. */
  get room(): RoomView<Game> | null {
    return this.#connection?.room ?? null;
  }

  /** The other people to draw in this frame, without those silent for 3 s. The array is reused in every frame. */
  get people(): readonly RemotePerson[] {
    return this.#people;
  }

  /**
   * The arena in the floor frame of this page, by its seat; a spectator's floor frame is the arena frame. Every change
   * yields another object.
   */
  get floorFromArena(): Transform<'floor', 'arena'> {
    const seat = this.room?.mySeat ?? null;
    if (!this.#connection || seat === null) return arenaIsFloor;
    const arenaFromFloor = this.#connection.arenaFromFloor(seat);
    if (arenaFromFloor !== this.#placedBy) {
      this.#placedBy = arenaFromFloor;
      this.#floorFromArena = invertTransform(arenaFromFloor);
    }
    return this.#floorFromArena;
  }

  /**
   * Returns the messages that have arrived, and plays the others back at this time [s]. Call it first in each frame.
   */
  update(time: number): ConnectionUpdate<Game> {
    this.#connection ??= this.#connect(time);
    const update = this.#connection.update(time);
    if (update.changes.includes('resumed')) this.#players.resume();
    for (const pose of update.poses) this.#players.receive(pose);
    this.#followSeats();
    this.#place(this.#connection, time);
    return update;
  }

  /** Sends the body of this frame, floor frame; 30 packets a second. Without a seat nothing is sent. */
  sendPose(time: number, pose: AvatarPose, fingers: Fingers): void {
    if (!this.#connection || this.room?.mySeat === null) return;
    this.#connection.sendPose(time, { jump: this.#jump, pose, fingers });
    this.#jump = false;
  }

  /** Marks the next pose as one that the others must not interpolate to: the floor frame has changed. */
  discontinuity(): void {
    this.#jump = true;
  }

  /** Prevents a person who takes a seat from gliding there from the previous person's position. */
  #followSeats(): void {
    const seats = this.room?.seats ?? noSeats;
    if (seats === this.#seats) return;
    for (let seat = 0; seat < seats.length; seat++) {
      const [now, before] = [seats[seat], this.#seats[seat]];
      if (now?.name !== before?.name || now?.bot !== before?.bot) this.#players.forget(seat);
    }
    this.#seats = seats;
  }

  #place(connection: Connection<Game>, time: number): void {
    this.#people.length = 0;
    const { floorFromArena } = this;
    const mySeat = connection.room?.mySeat;
    for (const person of this.#players.follow(time)) {
      const info = this.#seats[person.id];
      if (!info || person.id === mySeat) continue;
      person.calibration = info.calibration;
      person.avatar = info.avatar;
      composeTransforms(floorFromArena, connection.arenaFromFloor(person.id), person.placement);
      this.#people.push(person);
    }
  }
}
