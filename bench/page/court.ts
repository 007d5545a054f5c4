import {
  defaultAvatar,
  defaultCalibration,
  type Mutable,
  type RemotePerson,
  type Skeleton,
  skeletonFromCalibration,
} from 'threepoint/core';
import { parseAvatar } from 'threepoint/files';
import { createAvatarBetweenFrames, RemoteAvatars } from 'threepoint/internal/three';
import {
  composeTransforms,
  fromAxisAngle,
  invertTransform,
  type TrackedPose,
  type Transform,
  up,
  vec3,
} from 'threepoint/math';
import { ballRules } from 'threepoint-games/ball';
import { BallView } from '../../src/page/ball/ball-view';
import { simplifyAtDistance } from '../../src/page/people/match/simplify-at-distance';
import type { Quality } from '../../src/page/scene/renderer';
import type { Studio } from '../../src/page/studio/studio';
import { RemotePlayers } from '../../src/rooms/client/remote-players';
import { packetMs } from '../../src/rooms/protocol/packet-time';
import { decodePose } from '../../src/rooms/protocol/pose-codec';

/** What arrived of one seat. */
export interface ArrivedBytes {
  readonly seat: number;
  readonly bytes: Uint8Array;
}

/** Radius of the circle on which many bodies are placed [m]. */
const radius = 2.5;

/** Returns the pose of a body's floor in the arena: bodies stand on a circle and face its centre. */
function arenaFromCirclePlace(place: number, places: number): Transform<'arena', 'floor'> {
  const angle = (2 * Math.PI * place) / places;
  return {
    position: vec3(radius * Math.sin(angle), 0, radius * Math.cos(angle)),
    orientation: fromAxisAngle(up, angle),
  };
}

/** A ball court that stands still, one's own floor at the first of so many places, and the others on theirs. */
export class Court {
  readonly #studio: Studio;
  readonly #view: BallView;
  readonly #others: RemoteAvatars;
  readonly #skeleton: Skeleton = skeletonFromCalibration(defaultCalibration);
  readonly #seen: readonly Mutable<RemotePerson>[];
  readonly #people: RemotePerson[] = [];
  readonly #shown: Mutable<Parameters<BallView['show']>[0]>;
  readonly #players = new RemotePlayers();

  constructor(studio: Studio, mannequin: ArrayBuffer, places: number, quality: Quality = 'low') {
    this.#studio = studio;
    const floorFromArena = invertTransform(arenaFromCirclePlace(0, places));
    this.#view = new BallView({ quality, balls: 20, onCaption: () => undefined });
    studio.setSurroundings(this.#view.placed(floorFromArena));
    this.#others = new RemoteAvatars({
      load: async () =>
        simplifyAtDistance(await createAvatarBetweenFrames(await parseAvatar(mannequin, 'mannequin.vrm'))),
      plain: defaultAvatar,
      mouthOf: () => 0,
      onRefused: () => undefined,
    });
    studio.scene.add(this.#others.object);
    const nowhere = { position: { x: 0, y: 1.6, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
    const head: TrackedPose = { ...nowhere, tracking: 'tracked' };
    this.#seen = Array.from({ length: places }, (_, seat) => ({
      id: seat,
      calibration: defaultCalibration,
      avatar: defaultAvatar,
      palette: 'ember',
      pose: { head, leftHand: null, rightHand: null, body: null },
      placement: composeTransforms(floorFromArena, arenaFromCirclePlace(seat, places)),
      opacity: 1,
    }));
    this.#shown = {
      state: ballRules.start(['a', 'b', 'c'], 1),
      time: 0,
      players: [null, null, null],
      palms: [],
      me: null,
      opening: null,
      aim: null,
      secondsLeft: 90,
      pageTime: 0,
      inRoom: true,
      readyByItself: true,
      voices: { markOf: () => 'none', levelOf: () => 0 },
      hidden: new Set<number>(),
      isThere: () => true,
      paused: false,
      head: nowhere,
    };
  }

  /** Packets of the others, as if sent at this time [s]. */
  receive(arrived: readonly ArrivedBytes[], time: number): void {
    for (const { seat, bytes } of arrived) {
      const packet = decodePose(bytes, this.#skeleton);
      // A recording may restart; the sender's clock goes on.
      const timeMs = packetMs(time * 1000);
      if (packet) this.#players.receive({ seat, packet: { ...packet, timeMs }, arrivedAt: time });
    }
  }

  /** Poses the other bodies by their received packets. */
  showOthers(time: number): void {
    this.#people.length = 0;
    for (const { id, pose, opacity } of this.#players.follow(time)) {
      const person = this.#seen[id]!;
      person.pose = pose;
      person.opacity = opacity;
      this.#people.push(person);
    }
    this.#others.show(this.#people, time);
  }

  /** For a frame without them; they stay where they are. */
  hideOthers(time: number): void {
    this.#people.length = 0;
    this.#others.show(this.#people, time);
  }

  /** What stands about. */
  showCourt(time: number, head: TrackedPose): void {
    this.#shown.time = time;
    this.#shown.pageTime = time;
    this.#shown.head = head;
    this.#view.show(this.#shown);
  }

  /** Whether so many others are drawn: bodies are made one after the other when they are first seen. */
  shows(count: number): boolean {
    return this.#people.length === count && this.#people.every(({ id }) => this.#others.jointsOf(id) !== null);
  }

  dispose(): void {
    this.#others.dispose();
    this.#view.dispose();
    this.#studio.setSurroundings(null);
  }
}
