import { transformPose, type Vec3 } from 'threepoint/math';
import type { HostedGame } from 'threepoint-rooms/room';
import type { Watched } from '../../activity/activity';
import type { ActivityContext } from '../../activity/activity-context';
import type { CameraScene } from '../../scene/desktop-view';
import type { MatchPlay } from './match-play';

/** The views of a game at the desktop. */
export interface MatchScenes {
  /** The view past a player to the others. */
  readonly player: CameraScene;
  /** The view of the whole surroundings, for a spectator. */
  readonly spectator: CameraScene;
  /** The point that a spectator's camera looks at first, floor frame [m]. */
  readonly middle: Vec3;
}

export interface MatchCameraOptions {
  readonly context: Pick<ActivityContext, 'settings' | 'writer' | 'stage' | 'headset' | 'placeCamera'>;
  readonly play: Pick<MatchPlay<HostedGame>, 'newest'>;
  readonly scenes: MatchScenes;
  /** The drawn hips of the player on a seat, in the user's floor frame; undefined if that seat has no drawn player. */
  hipsOf(seat: number): Vec3 | undefined;
}

/** The desktop camera at a match: behind the user's body or, for a spectator, free or with a player. */
export class MatchCamera {
  readonly #options: MatchCameraOptions;

  constructor(options: MatchCameraOptions) {
    this.#options = options;
  }

  /** The user watches the match at the desktop. */
  get spectating(): boolean {
    const { play, context } = this.#options;
    return play.newest !== null && play.newest.me === null && !context.headset.worn;
  }

  get scene(): CameraScene {
    const { context, scenes } = this.#options;
    return this.spectating && context.settings.following === null ? scenes.spectator : scenes.player;
  }

  /** The person that a spectator's camera looks at; null: the user has a body. */
  get watched(): Watched | null {
    if (!this.spectating) return null;
    const { context, scenes } = this.#options;
    const { settings, stage } = context;
    const followed = settings.following === null ? null : this.#bodyOf(settings.following);
    return followed ?? { pelvis: scenes.middle, eyes: stage.view.pose };
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
