import type { Object3D } from 'three';
import { createRemoteAvatars, type RemoteAvatars } from 'threepoint/avatar/remote-avatars';
import type { AvatarRef } from 'threepoint/core/body/avatar-ref';
import { firstLine, reasonOf } from 'threepoint/core/errors/reasons';
import type { Vec3 } from 'threepoint/core/math/vec3';
import type { AvatarExchange } from 'threepoint-rooms/client/avatar-exchange';
import type { PlayerProbe } from '../activity/activity';
import type { ActivityContext } from '../activity/activity-context';
import type { BodyFrame } from './ball-frame';
import type { BallPlay } from './ball-play';
import { playersOf } from './player-probe';
import { SeenAvatars } from './seen-avatars';
import { SharedAvatar } from './shared-avatar';
import type { Voices } from './voices';

export interface CourtAvatarsOptions {
  readonly context: Pick<ActivityContext, 'settings' | 'avatar' | 'notices' | 'fetchBuiltInAvatar'>;
  /** null: avatar files are not exchanged in this room. */
  readonly exchange: AvatarExchange | null;
  /** The file of the body that other players have. */
  readonly mannequin: ArrayBuffer;
  readonly play: Pick<BallPlay, 'room' | 'wear' | 'newest'>;
  readonly voices: Pick<Voices, 'seats'>;
}

/** The avatars of the other players as drawn here, and the user's avatar as the others see it. */
export class CourtAvatars {
  readonly #options: CourtAvatarsOptions;
  readonly #others: RemoteAvatars;
  readonly #seen: SeenAvatars;
  readonly #shared: SharedAvatar;

  constructor(options: CourtAvatarsOptions) {
    const { context, exchange, mannequin, play, voices } = options;
    const { settings, avatar, notices } = context;
    this.#options = options;
    this.#seen = new SeenAvatars(mannequin, (name) => context.fetchBuiltInAvatar(name), exchange);
    this.#others = createRemoteAvatars({
      load: (worn) => this.#seen.load(worn),
      plain: () => settings.plainOthers,
      mouthOf: (seat) => voices.seats.mouthOf(seat),
      onRefused: (worn, reason) => this.#notifyRefused(worn, reason),
    });
    this.#shared = new SharedAvatar({
      exchange,
      wear: () => (settings.shareAvatar || avatar.isBuiltIn ? avatar.worn : null),
      send: (worn) => play.wear(worn),
      notify: (level, text) => notices.show(level, text),
    });
  }

  /** The bodies of the other players, to be added to the scene. */
  get object(): Object3D {
    return this.#others.object;
  }

  /** Once per frame, after the room's messages were received. */
  begin(): void {
    this.#shared.update(this.#options.play.room);
  }

  show(bodies: readonly BodyFrame[], time: number): void {
    this.#others.show(bodies, time);
  }

  /** The hips of the player on this seat as drawn, floor frame of the user; undefined: nobody is drawn there. */
  hipsOf(seat: number): Vec3 | undefined {
    return this.#others.jointsOf(seat)?.hips;
  }

  players(): readonly PlayerProbe[] {
    return playersOf(this.#options.play, this.#others);
  }

  dispose(): void {
    this.#seen.leave();
    this.#others.dispose();
  }

  #notifyRefused(worn: AvatarRef, reason: unknown): void {
    const { play, context } = this.#options;
    const seats = play.room?.seats ?? [];
    const names = seats.flatMap((seat, index) =>
      seat?.avatar === worn && index !== play.room?.mySeat ? [seat.name] : [],
    );
    // The player may have changed avatars in the meantime.
    if (names.length === 0) return;
    const why = firstLine(reasonOf(reason)).replace(/^the avatar: /, '');
    context.notices.show(
      'info',
      `The avatar of ${names.join(' and ')} could not be shown, so you see a mannequin. Reason: ${why}`,
    );
  }
}
