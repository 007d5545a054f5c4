import { type Camera, Group, type WebGLRenderer } from 'three';
import {
  actorFrame,
  createEstimator,
  defaultCalibration,
  nothingPressed,
  type PoseEstimator,
  type TrackingFrame,
} from 'threepoint/core';
import { parseAvatar } from 'threepoint/files';
import { composeTransforms, invertTransform } from 'threepoint/math';
import { type Avatar, createAvatarBetweenFrames } from 'threepoint/three';
import { ballRules, defaultBallOptions, stations } from 'threepoint-games/ball';
import { ArcheryPlay } from '../archery/archery-play';
import { type ArcheryView, createArcheryView } from '../archery/archery-view';
import { type BallScene, BallView } from '../ball/ball-view';
import type { Quality } from '../scene/renderer';
import type { Surroundings } from '../scene/surroundings';
import { Mirrors } from '../studio/mirrors';
import { createStudio, type Studio } from '../studio/studio';
import type { WorldName } from './headset-report';

const archerySettings = { bowSide: 'left', oneHanded: false, everyHitCounts: false } as const;
/** The offset between the other players in the actor's performance [s]. */
const actorOffset = 7;

const silent = () => undefined;

/** Another player of the ball court, moved by the built-in actor. */
interface OtherPlayer {
  readonly avatar: Avatar;
  readonly estimator: PoseEstimator;
}

/** The worlds of the page without a game in progress: mirror, archery with the bow, ball court for three. */
export class CheckWorlds {
  readonly avatar: Avatar;
  readonly #renderer: WebGLRenderer;
  readonly #studio: Studio;
  readonly #mirrors: Mirrors;
  readonly #archery: ArcheryView;
  readonly #archeryPlay: ArcheryPlay;
  readonly #ball: BallView;
  readonly #court: Surroundings;
  readonly #ballScene: Omit<BallScene, 'time' | 'pageTime' | 'head'>;
  readonly #others: readonly OtherPlayer[];
  readonly #otherBodies = new Group();
  #world: WorldName = 'mirror';

  private constructor(renderer: WebGLRenderer, quality: Quality, avatars: readonly [Avatar, Avatar, Avatar]) {
    this.#renderer = renderer;
    this.#studio = createStudio(renderer, quality);
    this.#mirrors = new Mirrors(quality);
    this.#archeryPlay = new ArcheryPlay(
      defaultCalibration,
      () => archerySettings,
      () => 7,
    );
    this.#archery = createArcheryView({
      quality,
      distances: this.#archeryPlay.targets.map(({ distance }) => distance),
      onCaption: silent,
    });
    this.#ball = new BallView({ quality, balls: defaultBallOptions.balls, onCaption: silent });
    const floorFromArena = invertTransform(stations[0]!);
    this.#court = this.#ball.placed(floorFromArena);
    this.#ballScene = {
      state: ballRules.start(['a', 'b', 'c'], 1),
      attendants: [null, null, null],
      palms: [],
      me: null,
      opening: null,
      aim: null,
      secondsLeft: defaultBallOptions.seconds,
      inRoom: true,
      readyByItself: true,
      voices: { markOf: () => 'none', levelOf: () => 0 },
      hidden: new Set<number>(),
      paused: false,
    };
    const [own, ...others] = avatars;
    this.avatar = own;
    this.#others = others.map((avatar, index) => {
      const { position, orientation } = composeTransforms(floorFromArena, stations[index + 1]!);
      avatar.object.position.copy(position);
      avatar.object.quaternion.copy(orientation);
      this.#otherBodies.add(avatar.object);
      return { avatar, estimator: createEstimator('ik', defaultCalibration) };
    });
    this.#studio.scene.add(this.#mirrors.object, this.#archery.bow, this.#otherBodies);
    own.setFirstPerson(true);
    this.show('mirror');
  }

  /** Builds the worlds and three bodies from the file of the built-in avatar. */
  static async create(renderer: WebGLRenderer, quality: Quality, file: ArrayBuffer): Promise<CheckWorlds> {
    const avatar = async () => createAvatarBetweenFrames(await parseAvatar(file, 'mannequin.vrm'));
    const worlds = new CheckWorlds(renderer, quality, [await avatar(), await avatar(), await avatar()]);
    await worlds.#studio.openWindows();
    return worlds;
  }

  get scene(): Studio['scene'] {
    return this.#studio.scene;
  }

  show(world: WorldName): void {
    this.#world = world;
    const place = { mirror: null, archery: this.#archery.range, ball: this.#court }[world];
    this.#studio.setSurroundings(place);
    this.#mirrors.place(world === 'archery' ? 'right' : null);
    this.#mirrors.setVisible(world !== 'ball');
    this.#archery.bow.visible = world === 'archery';
    this.#otherBodies.visible = world === 'ball';
  }

  /** Updates the world to a time [s] around this user. */
  update(time: number, frame: TrackingFrame): void {
    this.#studio.follow({ hips: frame.head.position });
    if (this.#world === 'archery') {
      const { state, bow, time: matchTime } = this.#archeryPlay.follow(frame, nothingPressed);
      this.#archery.show(state, bow, matchTime, frame.head);
    }
    if (this.#world !== 'ball') return;
    this.#ball.show({ ...this.#ballScene, time, pageTime: time, head: frame.head });
    this.#others.forEach(({ avatar, estimator }, index) => {
      const acted = { ...actorFrame(time + actorOffset * index, defaultCalibration), time };
      avatar.setPose(estimator.update(acted).pose, time);
    });
  }

  /** Draws the world at a time [s]. */
  draw(camera: Camera, time: number): void {
    this.#mirrors.reflect(this.#renderer, this.#studio.scene, camera, time);
    this.#renderer.render(this.#studio.scene, camera);
  }
}
