import { transformPose, type Vec3 } from 'threepoint/math';
import type { Watched } from '../../activity/activity';
import type { ActivityContext } from '../../activity/activity-context';
import type { BallPlay } from '../../ball/match/ball-play';
import type { CameraScene } from '../../scene/desktop-view';

/** The middle of the court, which a spectator's camera looks at first, floor frame [m]. */
const courtMiddle: Vec3 = { x: 0, y: 1, z: -2.4 };

/** The view past a player to the others, whose names are above their heads. */
const courtScene: CameraScene = {
  'third-person': {
    offset: { x: -0.8, y: 1.05, z: 3.5 },
    aim: { x: 0.3, y: 0.12, z: -2.4 },
    fovDegrees: 50,
    headroom: 0.5,
  },
  front: { offset: { x: -1.9, y: 0.6, z: -3.1 }, aim: { x: 0, y: 0, z: 0 }, fovDegrees: 50 },
};

/** The whole court from the side, for a spectator. */
const standsScene: CameraScene = {
  'third-person': { offset: { x: 4.6, y: 2.1, z: 4.6 }, aim: { x: 0.4, y: 0.15, z: 0 }, fovDegrees: 54 },
  front: { offset: { x: -4.6, y: 1.7, z: -3.6 }, aim: { x: 0, y: -0.1, z: 0 }, fovDegrees: 50 },
  free: true,
};

export interface CourtCameraOptions {
  readonly context: Pick<ActivityContext, 'settings' | 'writer' | 'stage' | 'headset' | 'placeCamera'>;
  readonly play: Pick<BallPlay, 'newest'>;
  /** The hips of the player on a seat as drawn, floor frame of the user; undefined: nobody is drawn there. */
  hipsOf(seat: number): Vec3 | undefined;
}

/** The desktop camera at the court: behind the user's body or, for a spectator, free or with a player. */
export class CourtCamera {
  readonly #options: CourtCameraOptions;

  constructor(options: CourtCameraOptions) {
    this.#options = options;
  }

  /** The user watches the match at the desktop. */
  get spectating(): boolean {
    const { play, context } = this.#options;
    return play.newest !== null && play.newest.me === null && !context.headset.worn;
  }

  get scene(): CameraScene {
    return this.spectating && this.#options.context.settings.following === null ? standsScene : courtScene;
  }

  /** The person that a spectator's camera looks at; null: the user has a body. */
  get watched(): Watched | null {
    if (!this.spectating) return null;
    const { settings, stage } = this.#options.context;
    const followed = settings.following === null ? null : this.#bodyOf(settings.following);
    return followed ?? { pelvis: courtMiddle, eyes: stage.view.pose };
  }

  /** Lets a spectator's camera follow the player on this seat; null: the camera is free. */
  follow(seat: number | null): void {
    const { writer, placeCamera } = this.#options.context;
    writer.change({ following: seat });
    placeCamera();
  }

  #bodyOf(seat: number): Watched | null {
    const { play, hipsOf } = this.#options;
    const body = play.newest?.bodies.find(({ id }) => id === seat);
    const pelvis = hipsOf(seat);
    if (!body || !pelvis) return null;
    const { position, orientation } = body.pose.head;
    return { pelvis, eyes: transformPose(body.placement, { position, orientation }) };
  }
}
