import { type Camera, Scene, type WebGLRenderer } from 'three';
import {
  actorFrame,
  defaultAvatar,
  defaultCalibration,
  nothingPressed,
  type PageClock,
  type TrackingFrame,
} from 'threepoint/core';
import { parseAvatar } from 'threepoint/files';
import { createAvatarBetweenFrames, GazeTargets } from 'threepoint/internal/three';
import { forward, rotate } from 'threepoint/math';
import type { Avatar } from 'threepoint/three';
import type { Activity, OpenActivity } from '../activity/activity';
import type { ActivityContext } from '../activity/activity-context';
import type { Quality } from '../scene/renderer';
import type { Surroundings, SurroundingsHost } from '../scene/surroundings';
import { activities, home } from '../shell/activity-registry';
import { createSettings, SettingsWriter } from '../shell/session/settings';
import { readSwitches } from '../shell/session/switches';
import { fetchBuiltInAvatar } from '../shell/stage/avatar-loader';
import { Mirrors } from '../studio/mirrors';
import { createStudio, type Studio } from '../studio/studio';
import type { WorldName } from './headset-report';

/** The layout of every round, so that all checks draw the same. */
const layoutSeed = 7;

interface CheckWorldsOptions {
  readonly renderer: WebGLRenderer;
  readonly quality: Quality;
  readonly clock: PageClock;
  /** The file of the body that the user and the other players have. */
  readonly mannequin: ArrayBuffer;
  onProblem(sentence: string): void;
}

/** An open activity, with its objects and surroundings apart from those of the other worlds. */
interface ActivityWorld extends SurroundingsHost {
  readonly activity: OpenActivity;
  readonly surroundings: Surroundings | null;
  readonly gazeTargets: GazeTargets;
}

const ignore = () => undefined;

/** What the activities read of a page whose user starts no round and has no server. */
function contextOf({ quality, clock, mannequin, onProblem }: CheckWorldsOptions) {
  const { switches } = readSwitches('');
  const settings = createSettings(switches, { preferences: { sound: false } }, null);
  return {
    quality,
    clock,
    settings,
    writer: new SettingsWriter(settings, { remember: ignore }, ignore),
    switches,
    pointer: () => null,
    // Rounds start as for a simulated player, so that nobody has to press Ready and bots play.
    headset: { worn: false, emulator: null },
    body: { calibration: defaultCalibration },
    avatar: { isBuiltIn: true, worn: defaultAvatar },
    fetchBuiltInAvatar: (name) => (name === defaultAvatar ? Promise.resolve(mannequin) : fetchBuiltInAvatar(name)),
    server: { state: 'none', whenKnown: async () => 'none', refresh: async () => 'none' },
    notices: { show: (_, text) => onProblem(text), withdraw: ignore },
    calm: matchMedia('(prefers-reduced-motion: reduce)'),
    study: { run: null },
    onCaption: ignore,
    onChange: ignore,
    place: null,
    inputSource: 'headset',
    chooseInput: ignore,
    setSound: ignore,
    reopen: ignore,
    placeCamera: ignore,
  } satisfies Omit<ActivityContext, 'stage' | 'gazeTargets' | 'layout'>;
}

/** Enters an activity as the page does, in a scene of its own. */
async function openActivity(activity: Activity, context: ReturnType<typeof contextOf>): Promise<ActivityWorld> {
  const host = {
    scene: new Scene(),
    gazeTargets: new GazeTargets(),
    surroundings: null as Surroundings | null,
    setSurroundings(surroundings: Surroundings | null) {
      host.surroundings = surroundings;
    },
  };
  const { head } = actorFrame(0, defaultCalibration);
  const view = {
    pose: head,
    rayThrough: () => ({ origin: head.position, direction: rotate(head.orientation, forward) }),
  };
  const own = { layout: { seed: layoutSeed }, stage: { studio: host, view }, gazeTargets: host.gazeTargets };
  return Object.assign(host, { activity: await activity.load({ ...context, ...own }) });
}

/** The worlds of the page: the mirror, and every activity of the registry. */
export class CheckWorlds {
  readonly avatar: Avatar;
  readonly #renderer: WebGLRenderer;
  readonly #studio: Studio;
  readonly #mirrors: Mirrors;
  readonly #activities: ReadonlyMap<WorldName, ActivityWorld>;
  /** null: the mirror. */
  #world: ActivityWorld | null = null;

  private constructor(
    { renderer, quality }: CheckWorldsOptions,
    avatar: Avatar,
    opened: ReadonlyMap<WorldName, ActivityWorld>,
  ) {
    this.#renderer = renderer;
    this.#studio = createStudio(renderer, quality);
    this.#mirrors = new Mirrors(quality);
    this.#activities = opened;
    this.avatar = avatar;
    this.#studio.scene.add(this.#mirrors.object);
    avatar.setFirstPerson(true);
    this.show(home);
  }

  /** Loads the body and all activities. Rejects with a reason. */
  static async create(options: CheckWorldsOptions): Promise<CheckWorlds> {
    const avatar = await createAvatarBetweenFrames(await parseAvatar(options.mannequin, 'mannequin.vrm'));
    const opened = new Map<WorldName, ActivityWorld>();
    const context = contextOf(options);
    for (const activity of activities) opened.set(activity.name, await openActivity(activity, context));
    const worlds = new CheckWorlds(options, avatar, opened);
    await worlds.#studio.openWindows();
    return worlds;
  }

  get scene(): Studio['scene'] {
    return this.#studio.scene;
  }

  show(name: WorldName): void {
    this.#world?.scene.removeFromParent();
    const world = this.#activities.get(name) ?? null;
    this.#world = world;
    this.#studio.setSurroundings(world?.surroundings ?? null);
    if (world) this.scene.add(world.scene);
    const side = world?.activity.mirrorSide ?? null;
    this.#mirrors.place(side);
    this.#mirrors.setVisible(world === null || side !== null);
  }

  /** Updates the world to a time [s] around this user. */
  update(time: number, frame: TrackingFrame): void {
    this.#studio.follow({ hips: frame.head.position });
    if (!this.#world) return;
    const { activity, gazeTargets } = this.#world;
    activity.begin?.(time);
    activity.update(frame, nothingPressed);
    activity.show(time, frame);
    gazeTargets.clear();
    this.#studio.setSurroundings(this.#world.surroundings);
  }

  /** Draws the world at a time [s]. */
  draw(camera: Camera, time: number): void {
    this.#mirrors.reflect(this.#renderer, this.#studio.scene, camera, time);
    this.#renderer.render(this.#studio.scene, camera);
  }
}
