import type { Object3D } from 'three';
import { type AvatarRef, defaultAvatar, firstLine, type RemotePerson, reasonOf } from 'threepoint/core';
import { type GazeTargets, RemoteAvatars } from 'threepoint/internal/three';
import type { Vec3 } from 'threepoint/math';
import type { Avatar } from 'threepoint/three';
import type { RoomView } from '../client/connection';
import { type OwnAvatar, SharedAvatar } from '../client/shared-avatar';
import type { HostedGame } from '../room/match-policy';
import { RoomAvatarLoader, type RoomAvatarLoaderOptions } from './room-avatar-loader';

export interface RoomBodiesOptions extends RoomAvatarLoaderOptions {
  /** Returns the room; null before the first welcome. */
  room(): RoomView<HostedGame> | null;
  /** Sends the reference of the own avatar to the room. */
  send(avatar: AvatarRef): void;
  /** Returns the user's avatar, the same object until it changes; null: it is not shared. Called in every frame. */
  wear(): OwnAvatar | null;
  /** Receives sentences about the own avatar. */
  notify(level: 'info' | 'warning', text: string): void;
  /** Receives a sentence about each avatar of another person that cannot be shown. */
  onRefused(text: string): void;
  /** Loads an avatar. Default: built-in bodies, and the files of the room. */
  readonly load?: ((avatar: AvatarRef) => Promise<Avatar>) | undefined;
  /** Returns whether all people are drawn as the mannequin. Default: false. */
  plain?(): boolean;
  /** Returns whether bodies breathe and shift their weight at rest. Default: false. */
  idles?(): boolean;
  /** Returns the opening of a person's mouth, 0 (shut) to 1. Default: 0. */
  mouthOf?(seat: number): number;
  /** Whether a soft shadow lies under each body. Default: false. */
  readonly shadows?: boolean;
  /** What attracts the eyes of the bodies apart from each other, floor frame; the owner clears it in every frame. */
  readonly gazeTargets?: GazeTargets;
}

/**
 * Draws the other people of a room in their avatars, and shares the user's avatar with them. Files of others are
 * validated before they are drawn; the mannequin replaces a file that is refused.
 */
export class RoomBodies {
  readonly #options: RoomBodiesOptions;
  readonly #drawn: RemoteAvatars;
  readonly #seen: RoomAvatarLoader;
  readonly #shared: SharedAvatar;

  constructor(options: RoomBodiesOptions) {
    const { exchange, wear, send, notify, plain = () => false, mouthOf = () => 0, shadows = false } = options;
    const { idles = () => false, gazeTargets } = options;
    this.#options = options;
    this.#seen = new RoomAvatarLoader(options);
    const load = options.load ?? ((avatar: AvatarRef) => this.#seen.load(avatar));
    const onRefused = (avatar: AvatarRef, reason: unknown) => this.#notifyRejected(avatar, reason);
    this.#drawn = new RemoteAvatars({
      load,
      plain: defaultAvatar,
      onlyPlain: plain,
      idles,
      mouthOf,
      onRefused,
      shadows,
      gazeTargets,
    });
    this.#shared = new SharedAvatar({ exchange, wear, send, notify });
  }

  /** The bodies; add the object to the scene at the origin of this page's floor. */
  get object(): Object3D {
    return this.#drawn.object;
  }

  /** Shares the user's avatar. Call it in each frame, after the room's messages were received. */
  share(): void {
    this.#shared.update(this.#options.room());
  }

  /** Draws exactly these people at a time [s] on the page's clock. */
  show(people: readonly RemotePerson[], time: number): void {
    this.#drawn.show(people, time);
  }

  /** Returns a person's drawn joints, floor frame of this page [m]; null: no person is drawn on this seat. */
  jointsOf(seat: number): Readonly<Record<string, Vec3>> | null {
    return this.#drawn.jointsOf(seat);
  }

  /** Returns the avatar that a person is drawn as; null: no person is drawn on this seat. */
  drawnAs(seat: number): AvatarRef | null {
    return this.#drawn.drawnAs(seat);
  }

  dispose(): void {
    this.#seen.dispose();
    this.#drawn.dispose();
  }

  #notifyRejected(avatar: AvatarRef, reason: unknown): void {
    const room = this.#options.room();
    const names = (room?.seats ?? []).flatMap((seat, index) =>
      seat?.avatar === avatar && index !== room?.mySeat ? [seat.name] : [],
    );
    // The player may have changed avatars in the meantime.
    if (names.length === 0) return;
    const why = firstLine(reasonOf(reason)).replace(/^the avatar: /, '');
    this.#options.onRefused(
      `The avatar of ${names.join(' and ')} could not be shown, so you see a mannequin. Reason: ${why}`,
    );
  }
}
