import type { Object3D } from 'three';
import { plainAvatar } from 'threepoint/core/body/avatar-ref';
import { type Calibration, sameMeasures } from 'threepoint/core/body/calibration';
import { unknownFingers } from 'threepoint/core/body/hand-shape';
import { reasonOf } from 'threepoint/core/errors/reasons';
import { type AvatarExchange, createAvatarExchange } from '../client/avatar-exchange';
import type { Connection, ConnectionStatus, ConnectionUpdate } from '../client/connection';
import { peopleClientPolicy } from '../client/people-client';
import { createRemotePlayers, type RemotePlayer } from '../client/remote-players';
import { createRoomPass, type Keep, tabStorage } from '../client/room-pass';
import { createSocketConnection } from '../client/socket-connection';
import type { SentBody } from '../peers/pose-sender';
import { withFingers } from '../peers/posed-fingers';
import type { SeatInfo } from '../protocol/messages';
import { type People, peopleKind } from '../room/people-policy';
import { type AvatarLoader, DrawnBodies, type DrawnPose } from './drawn-bodies';
import { PlacedPose } from './placed-pose';
import { loadRoomAvatar, uploadAvatar } from './room-avatars';
import { worldTransform } from './world-transform';

/** The wearer's body: a `BodyTracker` of threepoint is one. */
export interface RoomBody extends SentBody {
  /** Its object lies where the floor is. Absent: at the scene's origin. */
  readonly avatar?: { readonly object: Object3D };
  addEventListener?(type: 'discontinuity', listener: () => void): void;
  removeEventListener?(type: 'discontinuity', listener: () => void): void;
}

export interface JoinRoomOptions {
  /** The name that the others see; at most 20 characters of it. */
  readonly name: string;
  /** The body to send; null: watch without a place among the sixteen. */
  readonly body: RoomBody | null;
  /** The name of the room: lower-case letters, digits and hyphens, at most 32. Default: 'lobby'. */
  readonly room?: string;
  /** The file of the wearer's avatar, which the server passes on to the others. Default: they draw the mannequin. */
  readonly avatarFile?: Blob | null;
  /**
   * Returns the avatar to draw for another person; the reference is 'mannequin' or the hash of the file that they
   * uploaded. Default: that file, or the mannequin.
   */
  readonly avatar?: AvatarLoader;
  /** Keeps the pass, with which a reload takes the same place again. Default: the storage of the tab. */
  readonly storage?: Keep | null;
}

/** Another person in a room. */
export interface RoomPerson {
  readonly seat: number;
  readonly name: string;
  /** away: the page is hidden. gone: the connection is lost, and the place is held for 30 s. */
  readonly presence: SeatInfo['presence'];
}

/** A joined room. The connection comes back by itself until `leave`, or until the server ends it. */
export interface JoinedRoom {
  readonly others: {
    /** The object to add to the scene, with a body for each other person. */
    readonly object: Object3D;
    /** The other people of the room. */
    readonly people: readonly RoomPerson[];
  };
  readonly status: ConnectionStatus;
  /** The number of this page's place, 0 to 15; null: it watches. */
  readonly seat: number | null;
  /** Sends the body's pose and draws the others at this time [ms], on the page's clock; to be called in every frame. */
  update(timeMs: number): void;
  /** Gives up the place, ends the connection and removes the others. */
  leave(): void;
}

/** How often a room is tried before `joinRoom` gives up. */
const mostAttempts = 3;
/** How often the state of the first connection is read [ms]. */
const pollMs = 20;

/**
 * Joins a room of a server that has `attachRooms`, and draws the others in a three.js scene. `url`: the server's
 * address, with the path of `attachRooms` if it has one. Rejects with a sentence if the server cannot be reached,
 * refuses the page or has another version.
 *
 * @example
 * const room = await joinRoom('https://example.org', { name: 'Ada', body: tracker });
 * scene.add(room.others.object);
 * renderer.setAnimationLoop((timeMs, frame) => {
 *   tracker.update(timeMs, frame);
 *   room.update(timeMs);
 *   renderer.render(scene, camera);
 * });
 */
export async function joinRoom(
  url: string | URL,
  { name, body, room = 'lobby', avatarFile = null, avatar, storage = tabStorage() }: JoinRoomOptions,
): Promise<JoinedRoom> {
  const base = new URL(url, globalThis.location?.href).href.replace(/\/$/, '');
  const pass = createRoomPass(base, room, peopleKind, storage ?? undefined);
  // The socket repeats a failed request for ever: the first one states its reason.
  await pass.token(false).catch((error: unknown) => {
    throw new Error(`The room ${JSON.stringify(room)} at ${base} cannot be joined: ${reasonOf(error)}`);
  });
  const connection = createSocketConnection(peopleClientPolicy, {
    url: base,
    room,
    pass,
    visitor: { name, calibration: body?.calibration ?? standIn, spectate: body === null },
  });
  const exchange = createAvatarExchange(base, room, pass);
  await joined(connection, `The room ${JSON.stringify(room)} at ${base}`);
  const live = new LiveRoom(connection, body, avatar ?? ((reference) => loadRoomAvatar(exchange, reference)));
  if (avatarFile && live.seat !== null) await live.wear(exchange, avatarFile);
  return live;
}

/** The measures of a page that watches; no page draws them. */
const standIn: Calibration = { eyeHeight: 1.6, armSpan: 1.5 };

/** Resolves when the connection has joined; rejects, after ending it, when it cannot. */
async function joined(connection: Connection<People>, what: string): Promise<void> {
  for (;;) {
    connection.update(performance.now() / 1000);
    const { phase, attempt, reason } = connection.status;
    if (phase === 'joined' && connection.room) return;
    if (phase === 'ended' || attempt >= mostAttempts) {
      connection.leave();
      throw new Error(`${what} cannot be joined: ${reason === null ? 'no answer' : reasons[reason]}.`);
    }
    await new Promise((resolve) => setTimeout(resolve, pollMs));
  }
}

const reasons: Readonly<Record<NonNullable<ConnectionStatus['reason']>, string>> = {
  unreachable: 'the server does not answer',
  refused: 'the server refuses the pass',
  replaced: 'the same person has joined in another page',
  yielded: 'another person has the place',
  left: 'the page has left',
  misbehaved: 'the server found fault with the messages',
  slow: 'this page reads too slowly',
  stopping: 'the server is stopping',
  closed: 'the room was closed',
  'old-page': 'the server has another version of threepoint-rooms',
};

class LiveRoom implements JoinedRoom {
  readonly #connection: Connection<People>;
  readonly #body: RoomBody | null;
  readonly #players = createRemotePlayers();
  readonly #drawn: DrawnBodies;
  readonly #poses: SeatPose[] = [];
  readonly #shown: DrawnPose[] = [];
  readonly #placed = new PlacedPose();
  #calibration: Calibration | null;
  #seats: readonly (SeatInfo | null)[] = [];
  #people: readonly RoomPerson[] = [];
  #jump = false;
  readonly others: { readonly object: Object3D; readonly people: readonly RoomPerson[] };

  constructor(connection: Connection<People>, body: RoomBody | null, avatar: AvatarLoader) {
    this.#connection = connection;
    this.#body = body;
    this.#calibration = body?.calibration ?? null;
    this.#drawn = new DrawnBodies(avatar);
    const people = () => this.#people;
    this.others = {
      object: this.#drawn.object,
      get people() {
        return people();
      },
    };
    body?.addEventListener?.('discontinuity', this.#onDiscontinuity);
    globalThis.document?.addEventListener('visibilitychange', this.#onVisibility);
    this.#watchSeats();
  }

  get status(): ConnectionStatus {
    return this.#connection.status;
  }

  get seat(): number | null {
    return this.#connection.room?.mySeat ?? null;
  }

  async wear(exchange: AvatarExchange, file: Blob): Promise<void> {
    try {
      this.#connection.wear(await uploadAvatar(exchange, file));
    } catch (error) {
      this.#connection.wear(plainAvatar);
      console.warn(`threepoint-rooms: the others draw the mannequin: ${reasonOf(error)}`);
    }
  }

  update(timeMs: number): void {
    const time = timeMs / 1000;
    this.#receive(this.#connection.update(time));
    this.#send(time);
    const players = this.#players.follow(time);
    this.#shown.length = 0;
    for (let i = 0; i < players.length; i++) {
      const { seat } = players[i]!;
      const info = this.#seats[seat];
      if (!info) continue;
      this.#poses[seat] ??= new SeatPose(players[i]!);
      this.#shown.push(this.#poses[seat].of(players[i]!, info));
    }
    this.#drawn.draw(this.#shown, time);
  }

  leave(): void {
    this.#body?.removeEventListener?.('discontinuity', this.#onDiscontinuity);
    globalThis.document?.removeEventListener('visibilitychange', this.#onVisibility);
    this.#connection.leave();
    this.#drawn.dispose();
  }

  #receive({ poses }: ConnectionUpdate<People>): void {
    this.#watchSeats();
    for (let i = 0; i < poses.length; i++) this.#players.receive(poses[i]!);
  }

  #send(time: number): void {
    const body = this.#body;
    if (!body) return;
    if (!this.#calibration || !sameMeasures(body.calibration, this.#calibration)) {
      this.#calibration = body.calibration;
      this.#connection.calibrate(body.calibration);
    }
    if (!body.pose) return;
    const pose = body.avatar ? this.#placed.place(worldTransform(body.avatar.object), body.pose) : body.pose;
    this.#connection.sendPose(time, { jump: this.#jump, pose, fingers: body.pose.fingers ?? unknownFingers });
    this.#jump = false;
  }

  /** Follows the seats, so that no body glides from the place of the person who had the seat before. */
  #watchSeats(): void {
    const room = this.#connection.room;
    if (!room || room.seats === this.#seats) return;
    for (let seat = 0; seat < room.seats.length; seat++) {
      if (room.seats[seat]?.name === this.#seats[seat]?.name) continue;
      this.#players.forget(seat);
      this.#drawn.remove(peerOf(seat));
      delete this.#poses[seat];
    }
    this.#seats = room.seats;
    this.#people = room.seats.flatMap((info, seat): RoomPerson[] =>
      info && seat !== room.mySeat ? [{ seat, name: info.name, presence: info.presence }] : [],
    );
  }

  readonly #onDiscontinuity = (): void => {
    this.#jump = true;
  };

  readonly #onVisibility = (): void => this.#connection.away(document.hidden);
}

const peerOf = (seat: number): string => `seat ${seat}`;

/** What is drawn of the person on a seat; the same object in every frame. */
class SeatPose implements DrawnPose {
  readonly peer: string;
  readonly placement = null;
  readonly mouth = 0;
  readonly pose: DrawnPose['pose'];
  avatar: string | null = null;
  calibration = standIn;
  opacity = 1;

  constructor(player: RemotePlayer) {
    this.peer = peerOf(player.seat);
    this.pose = withFingers(player);
  }

  of({ opacity }: RemotePlayer, { avatar, calibration }: SeatInfo): this {
    this.avatar = avatar;
    this.calibration = calibration;
    this.opacity = opacity;
    return this;
  }
}
