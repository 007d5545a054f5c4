import { type BuiltInBody, defaultAvatar } from 'threepoint/core';
import { checkInWorker, loadUntrustedAvatar, parseAvatar } from 'threepoint/files';
import { createAvatarBetweenFrames, weaveCloth } from 'threepoint/internal/three';
import type { Avatar } from 'threepoint/three';
import type { RoomClient } from 'threepoint-rooms';
import type { AvatarExchange } from 'threepoint-rooms/internal';
import { RoomBodies } from 'threepoint-rooms/internal/three';
import type { HostedGame } from 'threepoint-rooms/room';
import { type ActivityContext, showsIdleMotion } from '../../activity/activity-context';
import { decoders } from '../../scene/decoders';
import type { Voices } from '../voices/voices';
import { simplifyAtDistance } from './simplify-at-distance';

export interface OtherBodiesOptions {
  readonly context: Pick<
    ActivityContext,
    | 'quality'
    | 'settings'
    | 'avatar'
    | 'notices'
    | 'gazeTargets'
    | 'fetchBuiltInAvatar'
    | 'calm'
    | 'study'
    | 'inputSource'
  >;
  /** null: avatar files are not exchanged in this room. */
  readonly exchange: AvatarExchange | null;
  /** The file of the body that other players have. */
  readonly mannequin: ArrayBuffer;
  readonly play: Pick<RoomClient<HostedGame>, 'room' | 'connection'>;
  readonly voices: Pick<Voices, 'seats'>;
}

/** Loads copies of the built-in bodies; each file is fetched once. */
export class BuiltInBodies {
  readonly #files = new Map<BuiltInBody, Promise<ArrayBuffer>>();
  readonly #fetch: (name: BuiltInBody) => Promise<ArrayBuffer>;

  /** `mannequin`: the file of the plain body; `fetch`: downloads another one. */
  constructor(mannequin: ArrayBuffer, fetch: (name: BuiltInBody) => Promise<ArrayBuffer>) {
    this.#files.set(defaultAvatar, Promise.resolve(mannequin));
    this.#fetch = fetch;
  }

  async load(body: BuiltInBody): Promise<Avatar> {
    const known = this.#files.get(body);
    const file = known ?? this.#fetch(body);
    if (!known) {
      this.#files.set(body, file);
      // A failed download is repeated when the body is needed again.
      file.catch(() => this.#files.delete(body));
    }
    return createAvatarBetweenFrames(await parseAvatar(await file, `${body}.vrm`));
  }
}

/** Creates the bodies of the other players as drawn here, and shares the user's avatar with the others. */
export function createOtherBodies({ context, exchange, mannequin, play, voices }: OtherBodiesOptions): RoomBodies {
  const { settings, avatar, notices } = context;
  const builtIn = new BuiltInBodies(mannequin, (name) => context.fetchBuiltInAvatar(name));
  return new RoomBodies({
    exchange,
    room: () => play.room,
    send: (worn) => play.connection?.setAvatar(worn),
    wear: () => (settings.shareAvatar || avatar.isBuiltIn ? avatar.worn : null),
    notify: (level, text) => notices.show(level, text),
    onRefused: (text) => notices.show('info', text),
    async loadBuiltIn(body) {
      const loaded = await simplifyAtDistance(await builtIn.load(body));
      loaded.setClothWeave(context.quality === 'high' ? weaveCloth : null);
      return loaded;
    },
    loadFile: async (bytes) =>
      simplifyAtDistance(await loadUntrustedAvatar(bytes, 'the avatar', { check: checkInWorker, decoders })),
    plain: () => settings.plainOthers,
    idles: () => showsIdleMotion(context, context.inputSource),
    mouthOf: (seat) => voices.seats.mouthOf(seat),
    shadows: true,
    gazeTargets: context.gazeTargets,
  });
}
