import { avatarLimits, sha256Base64Url } from 'threepoint';
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
import { type Avatar, bodyLabelOf, createAvatarBetweenFrames } from 'threepoint/three';
import type { OwnAvatar } from 'threepoint-rooms';
import { type FileKind, fileNameOf, pageFolder, readLimited } from 'threepoint-ui';
import { decoders } from '../../scene/decoders';
import type { BoneMapStore } from './bone-map-store';

export const avatarFile: FileKind = { what: 'an avatar', megabytes: avatarLimits.megabytes };

/** Downloads a built-in avatar. `onProgress` is called with the share [0, 1] that has arrived. */
export const fetchBuiltInAvatar = (name: BuiltInBody, onProgress?: (share: number) => void): Promise<ArrayBuffer> =>
  readLimited(`${pageFolder()}/avatars/${name}.vrm`, avatarFile, onProgress && { onProgress });

/** A checked file without its bytes, which can be read from it again. */
export type AvatarFile = Omit<CheckedAvatar, 'bytes'>;

/** Builds a built-in avatar from its file. */
export const buildBuiltIn = async (
  body: BuiltInBody,
  bytes: Promise<ArrayBuffer> = fetchBuiltInAvatar(body),
): Promise<Avatar> => createAvatarBetweenFrames(await parseAvatar(await bytes, bodyLabelOf(body)));

/** An avatar, and the reference by which other players see it. */
export interface LoadedUserAvatar {
  readonly avatar: Avatar;
  readonly worn: OwnAvatar;
  /** Its file, and the map of its bones that the user gave (undefined: none); null: a built-in avatar. */
  readonly source: { readonly checked: AvatarFile; readonly bones: BoneMap | undefined } | null;
}

/**
 * Returns the file for other players, who have no map of its bones. Its hash is null if this page cannot compute it.
 */
async function fileFor({ bytes, file, hash }: CheckedAvatar, bones: BoneMap | undefined) {
  if (!bones) return { file, hash };
  const named = await withNamedBones(bytes, bones);
  return { file: new Blob([named]), hash: await sha256Base64Url(named) };
}

const withBytes = async (checked: AvatarFile): Promise<CheckedAvatar> => ({
  ...checked,
  bytes: await checked.file.arrayBuffer(),
});

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
  ): Promise<LoadedUserAvatar> {
    return { avatar: await buildBuiltIn(body, bytes), worn: builtInAvatarOf(body, skinTone), source: null };
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
  build(checked: CheckedAvatar, name: string): Promise<LoadedUserAvatar> {
    return this.#build(checked, name, checked.hash === null ? undefined : this.#boneMaps.of(checked.hash));
  }

  /**
   * Builds the avatar of a checked file with these bones, and stores them for the file. null: without a map, which is
   * forgotten.
   */
  async buildWith(checked: AvatarFile, name: string, bones: BoneMap | null): Promise<LoadedUserAvatar> {
    const loaded = await this.#build(await withBytes(checked), name, bones ?? undefined);
    if (checked.hash !== null && bones) this.#boneMaps.store(checked.hash, bones);
    else if (checked.hash !== null) this.#boneMaps.forget(checked.hash);
    return loaded;
  }

  /** Reads the bones of a checked file, and what they are without a map. */
  async bonesOf(checked: AvatarFile, name: string): Promise<ReadBones> {
    return readFileBones(await withBytes(checked), name, decoders);
  }

  async #build(checked: CheckedAvatar, name: string, bones: BoneMap | undefined): Promise<LoadedUserAvatar> {
    const avatar = await createAvatarBetweenFrames(await parseChecked(checked, name, { decoders, bones }));
    try {
      await this.#prepare(avatar.object);
      const { bytes: _, ...file } = checked;
      return { avatar, worn: { name, ...(await fileFor(checked, bones)) }, source: { checked: file, bones } };
    } catch (error) {
      avatar.dispose();
      throw error;
    }
  }
}
