import { type BoneMap, type BuiltInBody, builtInAvatarOf, type SkinTone } from 'threepoint/core';
import {
  type CheckedAvatar,
  checkInWorker,
  parseAvatar,
  parseChecked,
  type ReadBones,
  readFileBones,
  withNamedBones,
} from 'threepoint/files';
import { avatarLimits, sha256Base64Url } from 'threepoint/internal';
import { bodyLabelOf, createAvatar, createAvatarBetweenFrames } from 'threepoint/internal/three';
import type { Avatar } from 'threepoint/three';
import type { OwnAvatar } from 'threepoint-rooms/internal';
import { type FileKind, fileNameOf, pageFolder, readLimited } from 'threepoint-ui';
import { decoders } from '../../scene/decoders';
import type { BoneMapStore } from './bone-map-store';

const avatarFile: FileKind = { what: 'an avatar', megabytes: avatarLimits.megabytes };

/** Downloads a built-in avatar. `onProgress` is called with the share [0, 1] that has arrived. */
export const fetchBuiltInAvatar = (name: BuiltInBody, onProgress?: (share: number) => void): Promise<ArrayBuffer> =>
  readLimited(`${pageFolder()}/avatars/${name}.vrm`, avatarFile, onProgress && { onProgress });

/** Builds a built-in avatar. `bytes`: its file, at the start of the page, when no frame is drawn that could be late. */
export const buildBuiltIn = async (body: BuiltInBody, bytes?: Promise<ArrayBuffer>): Promise<Avatar> => {
  const loaded = await parseAvatar(await (bytes ?? fetchBuiltInAvatar(body)), bodyLabelOf(body));
  return bytes ? createAvatar(loaded) : createAvatarBetweenFrames(loaded);
};

/** An avatar, and the file or the built-in body that other players see. */
export interface UserAvatarState {
  readonly avatar: Avatar;
  readonly worn: OwnAvatar;
  /** The user's own file; null: a built-in avatar. */
  readonly checked: CheckedAvatar | null;
  /** The map of the file's bones that the user gave. */
  readonly bones?: BoneMap | undefined;
}

/** Returns the file for other players, who have no map of its bones. */
async function fileFor(checked: CheckedAvatar, bones: BoneMap | undefined): Promise<OwnAvatar> {
  if (!bones) return checked;
  const named = await withNamedBones(await checked.file.arrayBuffer(), bones);
  return { name: checked.name, file: new Blob([named]), hash: await sha256Base64Url(named) };
}

/** Loads avatars from files, addresses and the page's folder. */
export class AvatarLoader {
  readonly #boneMaps: BoneMapStore;
  readonly #prepare: (object: Avatar['object']) => Promise<void>;

  /**
   * `boneMaps`: the bone maps that users gave for files. `prepare`: uploads an avatar to the graphics device before it
   * is shown.
   */
  constructor(boneMaps: BoneMapStore, prepare: (object: Avatar['object']) => Promise<void>) {
    this.#boneMaps = boneMaps;
    this.#prepare = prepare;
  }

  /** Loads a built-in avatar. `bytes`: its file, if the download has started already. */
  async loadBuiltIn(
    body: BuiltInBody,
    skinTone: SkinTone | undefined,
    bytes?: Promise<ArrayBuffer>,
  ): Promise<UserAvatarState> {
    return { avatar: await buildBuiltIn(body, bytes), worn: builtInAvatarOf(body, skinTone), checked: null };
  }

  /** Reads a file and checks it in a worker. */
  async check(
    source: string | File,
    options: { readonly onProgress: (share: number) => void; readonly signal: AbortSignal },
  ): Promise<CheckedAvatar> {
    const bytes = await readLimited(source, avatarFile, options);
    return checkInWorker(bytes, { name: fileNameOf(source), supportedCompressions: Object.keys(decoders) });
  }

  /**
   * Builds the avatar of a checked file with the bones that the user gave for it before. Rejects with UnknownBonesError
   * if they are unknown.
   */
  build(checked: CheckedAvatar): Promise<UserAvatarState> {
    return this.#build(checked, checked.hash === null ? undefined : this.#boneMaps.of(checked.hash));
  }

  /**
   * Builds the avatar of a checked file with these bones, and stores them for the file. null: without a map, which is
   * forgotten.
   */
  async buildWith(checked: CheckedAvatar, bones: BoneMap | null): Promise<UserAvatarState> {
    const built = await this.#build(checked, bones ?? undefined);
    if (checked.hash !== null && bones) this.#boneMaps.store(checked.hash, bones);
    else if (checked.hash !== null) this.#boneMaps.forget(checked.hash);
    return built;
  }

  /** Reads the bones of a checked file, and what they are without a map. */
  bonesOf(checked: CheckedAvatar): Promise<ReadBones> {
    return readFileBones(checked, decoders);
  }

  async #build(checked: CheckedAvatar, bones: BoneMap | undefined): Promise<UserAvatarState> {
    const avatar = await createAvatarBetweenFrames(await parseChecked(checked, { decoders, bones }));
    try {
      await this.#prepare(avatar.object);
      return { avatar, worn: await fileFor(checked, bones), checked, bones };
    } catch (error) {
      avatar.dispose();
      throw error;
    }
  }
}
