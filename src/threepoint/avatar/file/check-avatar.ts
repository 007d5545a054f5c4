import { reasonOf } from '../../core/errors/reasons';
import { type AvatarLimits, avatarLimits } from './avatar-limits';
import { convertToGlb } from './convert-to-glb';
import { sha256Base64Url } from './file-hash';
import { inspectAvatar } from './inspect-avatar';
import { gltfFaults } from './validate-gltf';

/** The options of a check. */
export interface AvatarCheckOptions {
  /** The name of the file for messages. */
  readonly name: string;
  /** The extensions of compression that can be decoded. */
  readonly supportedCompressions: readonly string[];
  /** Absent: `avatarLimits`. */
  readonly limits?: AvatarLimits;
}

/** A file that has passed the check: VRM or GLB, or a converted FBX. */
export interface CheckedAvatar {
  readonly bytes: ArrayBuffer;
  /** The file as a Blob, of which parts can be read without a copy. */
  readonly file: Blob;
  /** The supported compressions that the file uses. */
  readonly usedCompressions: readonly string[];
  /** SHA-256 of the file as base64url; null: the page is no secure context, in which browsers hash. */
  readonly hash: string | null;
}

/** Checks a file without decoding it; the bytes may be transferred. Rejects with an Error that names the file. */
export type AvatarCheck = (bytes: ArrayBuffer, question: AvatarCheckOptions) => Promise<CheckedAvatar>;

/** Checks a file on the calling thread. */
export const checkAvatar: AvatarCheck = async (given, { name, supportedCompressions, limits = avatarLimits }) => {
  const bytes = await convertToGlb(given, name, 'body');
  const file = new Uint8Array(bytes);
  const usedCompressions = inspectAvatar(file, name, supportedCompressions, limits);
  const faults = await gltfFaults(file).catch((error: unknown) => {
    throw new Error(`${name}: could not be checked (${reasonOf(error)})`);
  });
  if (faults.length > 0) throw new Error(`${name}: not valid glTF (${faults[0]})`);
  return { bytes, file: new Blob([bytes]), usedCompressions, hash: await sha256Base64Url(bytes) };
};
