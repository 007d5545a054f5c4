import { Object3D } from 'three';
import {
  type AvatarRef,
  type Calibration,
  defaultAvatar,
  reasonOf,
  sameMeasures,
  unknownFingers,
} from 'threepoint/core';
import { sha256Base64Url } from 'threepoint/internal';
import { type Avatar, loadAvatar, loadMannequin } from 'threepoint/three';
import * as v from 'valibot';
import type { ClientPolicy } from '../client/client-policy';
import type { Connection, ConnectionStatus, ConnectionUpdate, Visitor } from '../client/connection';
import { endings } from '../client/connection-text';
import { RoomAddress } from '../client/room-address';
import { RoomClient } from '../client/room-client';
import { type PassStorage, tabStorage } from '../client/room-pass';
import type { OwnAvatar } from '../client/shared-avatar';
import type { PoseSource } from '../peers/pose-sender';
import { roomMessageReader, type SeatInfo } from '../protocol/messages';
import { headBits } from '../protocol/pose-steps';
import { maxSteps, placeUnit } from '../protocol/quantise';
import type { HostedGame } from '../room/match-policy';
import { noMatchState, type People, peopleKind, sharedFloor } from '../room/people-policy';
import { PlacedPose } from './placed-pose';
import { RoomBodies } from './room-bodies';
import { relativeTransform } from './world-transform';

/** The user's body: a `BodyTracker` of threepoint, for example. */
export interface RoomBody extends PoseSource {
  /** The avatar whose object is placed on the floor. Default: the floor is at the origin of `others.object`. */
  readonly avatar?: { readonly object: Object3D };
  addEventListener?(type: 'discontinuity', listener: () => void): void;
  removeEventListener?(type: 'discontinuity', listener: () => void): void;
}

export interface JoinRoomOptions<Game extends HostedGame = People> {
  /** The name that the others see; at most 20 characters of it. */
  readonly name: string;
  /** The body to send; null: join as a spectator, without a seat. */
  readonly body: RoomBody | null;
  /** The name of the room: lower-case letters, digits and hyphens, at most 32. Default: 'lobby'. */
  readonly room?: string;
  /** The client policy of the room's game; the server needs its match policy. Default: a room without a game. */
  readonly game?: ClientPolicy<Game>;
  /**
   * The radius [m] of the circle on which the people stand, facing each other; its middle is the origin of
   * `others.object`. 0: all stand there, as people in one real place do. Default: 1.5, and 0 in the arena of a game.
   */
  readonly circle?: number;
  /** The file of the user's avatar, which the server sends to the others. Default: they draw the mannequin. */
  readonly avatarFile?: Blob | null;
  /**
   * Loads the avatar of another person; the reference is 'mannequin' or the hash of the file that they uploaded.
   * Default: that file, validated and within the limits of untrusted files, or the mannequin.
   */
  readonly avatar?: (reference: AvatarRef) => Promise<Avatar>;
  /** Stores the pass, by which a reloaded page gets its seat back. Default: the storage of the tab. */
  readonly storage?: PassStorage | null;
}

/** Another person in a room. */
export interface RoomPerson {
  readonly seat: number;
  readonly name: string;
  /** away: the page is hidden. gone: the connection is lost, and the seat is held for 30 s. */
  readonly presence: SeatInfo['presence'];
}

/** A joined room. It reconnects until `leave` is called or the server ends the connection. */
export interface JoinedRoom<Game extends HostedGame = People> {
  readonly others: {
    /**
     * The floor that the people of the room share, with a body for each other person: add it to the scene, and to it
     * what all of them see in one place. People are within 8.19 m of its origin.
     */
    readonly object: Object3D;
    /** The other people of the room. */
    readonly people: readonly RoomPerson[];
  };
  readonly status: ConnectionStatus;
  /** The number of this page's seat, 0 to 15; null: a spectator. */
  readonly seat: number | null;
  /** The client of the room: its state, the actions of its game, its voices. */
  readonly client: RoomClient<Game>;
  /**
   * Sends the body's pose and draws the others at this time [ms] on the page's clock. Call it in every frame. Returns
   * the events of the game since the last call.
   */
  update(timeMs: number): ConnectionUpdate<Game>;
  /** Gives up the seat, ends the connection and removes the others. */
  leave(): void;
}

/** The client policy of a room without a game. */
const peopleClientPolicy: ClientPolicy<People> = {
  kind: peopleKind,
  readMessage: roomMessageReader<People>(peopleKind, v.null(), v.never()),
  unpack: () => noMatchState,
  follow: (state) => state,
  at: (state) => state,
  predict: (state) => state,
  answers: () => false,
  arenaFromFloor: () => sharedFloor,
};

/** The number of attempts before `joinRoom` rejects. */
const maxAttempts = 3;
/** The usual radius of the circle on which the people of a room without a game stand [m]. */
const usualCircle = 1.5;
/** The measures of a spectator, which no page draws. */
const spectatorCalibration: Calibration = { eyeHeight: 1.6, armSpan: 1.5 };
/** The largest x and z of a head in a packet [m]. */
const farthest = maxSteps(headBits) * placeUnit;

/**
 * Joins a room of a server that uses `attachRooms`, and draws the others in a three.js scene. `url`: the server's URL,
 * with the path of `attachRooms` if it has one. Rejects with an Error if the server cannot be reached, refuses the page
 * or has another version.
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
export async function joinRoom<Game extends HostedGame = People>(
  url: string | URL,
  options: JoinRoomOptions<Game>,
): Promise<JoinedRoom<Game>> {
  const { name, body, room = 'lobby', avatarFile = null, storage = tabStorage() } = options;
  // reason: without a game, Game is People.
  const game = options.game ?? (peopleClientPolicy as unknown as ClientPolicy<Game>);
  const base = new URL(url, globalThis.location?.href).href.replace(/\/$/, '');
  const address = new RoomAddress(game, { url: base, room, ...(storage && { storage }) });
  const visitor = { name, calibration: body?.calibration ?? spectatorCalibration, spectate: body === null };
  const worn = avatarFile ? await ownAvatarFrom(avatarFile) : defaultAvatar;
  // A frame cannot report that the default body is missing.
  const ready = options.avatar ? [] : [await loadMannequin()];
  const loadBuiltIn = async () => ready.pop() ?? loadMannequin();
  const connection = await connect(address, visitor).catch((error: unknown) => {
    throw new Error(`The room ${JSON.stringify(room)} at ${base} cannot be joined: ${reasonOf(error)}`);
  });
  return new JoinedRoomImplementation(connection, address, options, { worn, loadBuiltIn });
}

const ownAvatarFrom = async (file: Blob): Promise<OwnAvatar> => ({
  name: 'your avatar',
  file,
  hash: await sha256Base64Url(await file.arrayBuffer()),
});

/** Resolves to a connection that has joined; rejects, after ending it, when it cannot. */
async function connect<Game extends HostedGame>(
  address: RoomAddress<Game>,
  visitor: Visitor,
): Promise<Connection<Game>> {
  // The socket retries forever; the reason of the first failure is reported.
  await address.pass.token(false);
  return new Promise((resolve, reject) => {
    let settled = false;
    const connection = address.connect(visitor, () => {
      const { phase, attempt, reason } = connection.status;
      if (settled || (phase !== 'joined' && phase !== 'ended' && attempt < maxAttempts)) return;
      settled = true;
      if (phase === 'joined') {
        resolve(connection);
        return;
      }
      connection.leave();
      reject(new Error(reason === null ? 'no answer' : endings[reason]));
    });
  });
}

class JoinedRoomImplementation<Game extends HostedGame> implements JoinedRoom<Game> {
  readonly client: RoomClient<Game>;
  readonly others: JoinedRoom['others'];
  readonly #body: RoomBody | null;
  readonly #bodies: RoomBodies;
  readonly #placed = new PlacedPose();
  readonly #circle: number;
  /** The floor of a body without an avatar; null: at that of `others.object`. */
  readonly #floor: Object3D | null;
  /** The seat whose place on the circle is taken; null: none yet. */
  #placedSeat: number | null = null;
  #calibration: Calibration | null;
  #warnedOfDistance = false;

  constructor(
    connection: Connection<Game>,
    address: RoomAddress<Game>,
    { body, avatar: load, game, circle = game ? 0 : usualCircle }: JoinRoomOptions<Game>,
    { worn, loadBuiltIn }: { readonly worn: OwnAvatar; loadBuiltIn(): Promise<Avatar> },
  ) {
    const client = new RoomClient(connection);
    const people = new OtherPeople();
    this.client = client;
    this.#body = body;
    this.#circle = circle;
    this.#floor = circle > 0 ? new Object3D() : null;
    this.#calibration = body?.calibration ?? null;
    this.#bodies = new RoomBodies({
      exchange: address.avatars,
      room: () => connection.room,
      send: (avatar) => connection.setAvatar(avatar),
      wear: () => worn,
      notify: (level, text) => level === 'warning' && console.warn(`threepoint-rooms: ${text}`),
      onRefused: (text) => console.warn(`threepoint-rooms: ${text}`),
      loadBuiltIn,
      loadFile: (bytes) => loadAvatar(bytes, { untrusted: true }),
      load: load && ((avatar) => loadedBy(load, avatar)),
    });
    this.others = {
      object: this.#bodies.object,
      get people() {
        return people.of(client);
      },
    };
    this.#standOnCircle();
    body?.addEventListener?.('discontinuity', this.#onDiscontinuity);
    globalThis.document?.addEventListener('visibilitychange', this.#onVisibility);
  }

  get status(): ConnectionStatus {
    return this.client.status;
  }

  get seat(): number | null {
    return this.client.room?.mySeat ?? null;
  }

  update(timeMs: number): ConnectionUpdate<Game> {
    const time = timeMs / 1000;
    const update = this.client.update(time);
    this.#standOnCircle();
    this.#bodies.share();
    this.#send(time);
    this.#bodies.show(this.client.people, time);
    return update;
  }

  leave(): void {
    this.#body?.removeEventListener?.('discontinuity', this.#onDiscontinuity);
    globalThis.document?.removeEventListener('visibilitychange', this.#onVisibility);
    this.client.connection?.leave();
    this.#bodies.dispose();
  }

  /** Places the shared floor for a user who has taken a seat, or another one after a lost connection. */
  #standOnCircle(): void {
    const { seat } = this;
    if (seat === this.#placedSeat || seat === null || this.#circle === 0) return;
    this.#placedSeat = seat;
    const { object } = this.others;
    // The middle of the circle is ahead of every user, and the circle is turned under them.
    object.position.set(0, 0, -this.#circle);
    object.rotation.set(0, -2 * Math.PI * placeOnCircle(seat), 0);
    // A user at another place of the shared floor moves there at once.
    this.client.discontinuity();
  }

  #send(time: number): void {
    const body = this.#body;
    if (!body) return;
    if (!this.#calibration || !sameMeasures(body.calibration, this.#calibration)) {
      this.#calibration = body.calibration;
      this.client.connection?.calibrate(body.calibration);
    }
    if (!body.pose) return;
    const floor = body.avatar?.object ?? this.#floor;
    const othersFromFloor = floor && relativeTransform(floor, this.others.object);
    const pose = othersFromFloor ? this.#placed.place(othersFromFloor, body.pose) : body.pose;
    this.#warnOfDistance(Math.max(Math.abs(pose.head.position.x), Math.abs(pose.head.position.z)));
    this.client.sendPose(time, pose, body.pose.fingers ?? unknownFingers);
  }

  #warnOfDistance(metres: number): void {
    if (this.#warnedOfDistance || !(metres > farthest)) return;
    this.#warnedOfDistance = true;
    console.warn(
      `threepoint-rooms: The body is ${metres.toFixed(1)} m from the origin of room.others.object, and the others draw ` +
        `it at ${farthest.toFixed(2)} m. Add room.others.object to a group near the people of the room.`,
    );
  }

  readonly #onDiscontinuity = (): void => this.client.discontinuity();

  readonly #onVisibility = (): void => this.client.connection?.setAway(document.hidden);
}

/** Returns a seat's place on a circle as a fraction of its length, so that few people stand far apart. */
function placeOnCircle(seat: number): number {
  let place = 0;
  for (let bit = 0; bit < 4; bit++) if (seat & (1 << bit)) place += 0.5 ** (bit + 1);
  return place;
}

/** The list of the other people, which is the same until a seat changes. */
class OtherPeople {
  #seats: readonly (SeatInfo | null)[] | null = null;
  #mySeat: number | null = null;
  #people: readonly RoomPerson[] = [];

  of({ room }: Pick<RoomClient<HostedGame>, 'room'>): readonly RoomPerson[] {
    if (!room || (room.seats === this.#seats && room.mySeat === this.#mySeat)) return this.#people;
    const { seats, mySeat } = room;
    this.#seats = seats;
    this.#mySeat = mySeat;
    this.#people = seats.flatMap((info, seat): RoomPerson[] =>
      info && seat !== mySeat ? [{ seat, name: info.name, presence: info.presence }] : [],
    );
    return this.#people;
  }
}

/** Returns the avatar that the page loads, or the mannequin if that fails. */
async function loadedBy(load: (avatar: AvatarRef) => Promise<Avatar>, avatar: AvatarRef): Promise<Avatar> {
  if (avatar !== defaultAvatar) return load(avatar);
  return load(avatar).catch((error: unknown) => {
    console.warn(`threepoint-rooms: the page's own avatar is replaced by the mannequin: ${reasonOf(error)}`);
    return loadMannequin();
  });
}
