import { reasonOf } from '../../core/errors/reasons';
import { type AvatarLimits, avatarLimits } from './avatar-limits';
import { glbOfFile } from './convert-to-glb';
import { hashOf } from './file-hash';
import { inspectAvatar } from './inspect-avatar';
import { gltfFaults } from './validate-gltf';

/** What a file is looked at for. */
export interface AvatarQuestion {
  /** What sentences call it. */
  readonly name: string;
  /** Extensions of compression that can be unpacked. */
  readonly unpacked: readonly string[];
  /** Absent: `avatarLimits`. */
  readonly limits?: AvatarLimits;
}

/** A file that may be read: VRM or GLB, or what FBX was converted to. */
export interface CheckedAvatar {
  readonly bytes: ArrayBuffer;
  /** The file as a Blob, of which parts can be read without a copy. */
  readonly file: Blob;
  /** Which of the extensions asked about it uses. */
  readonly packed: readonly string[];
  /** SHA-256 of the file as base64url; null: this page has no secure context, in which alone browsers hash. */
  readonly hash: string | null;
}

/**
 * Looks at a file without drawing anything of it, and may take its bytes along. Rejects with a sentence that names the
 * file.
 */
export type AvatarCheck = (bytes: ArrayBuffer, question: AvatarQuestion) => Promise<CheckedAvatar>;

/** The check itself, on the thread that calls it. */
export const checkAvatar: AvatarCheck = async (given, { name, unpacked, limits = avatarLimits }) => {
  const bytes = await glbOfFile(given, name, 'body');
  const file = new Uint8Array(bytes);
  const packed = inspectAvatar(file, name, unpacked, limits);
  const faults = await gltfFaults(file).catch((error: unknown) => {
    throw new Error(`${name}: could not be checked (${reasonOf(error)})`);
  });
  if (faults.length > 0) throw new Error(`${name}: not valid glTF (${faults[0]})`);
  return { bytes, file: new Blob([bytes]), packed, hash: await hashOf(bytes) };
};
