import { validateBytes } from 'gltf-validator';
import { reasonOf } from '../../core/errors/reasons';
import { type AvatarLimits, avatarLimits } from './avatar-limits';
import { convertToGlb } from './convert-to-glb';
import { sha256Base64Url } from './file-hash';
import { inspectAvatar } from './inspect-avatar';

export interface AvatarCheckOptions {
  readonly name: string;
  /** The extensions of compression that can be decoded. */
  readonly supportedCompressions: readonly string[];
  /** Absent: `avatarLimits`. */
  readonly limits?: AvatarLimits;
}

/** A file that has passed the check: VRM or GLB, or a converted FBX. */
export interface CheckedAvatar {
  readonly name: string;
  readonly file: Blob;
  /** The supported compressions that the file uses. */
  readonly usedCompressions: readonly string[];
  /** SHA-256 of the file as base64url; null: the page is no secure context, in which browsers hash. */
  readonly hash: string | null;
}

/** Checks a file without decoding it; the given bytes may be transferred. Rejects with an Error that names the file. */
export type AvatarCheck = (bytes: ArrayBuffer, question: AvatarCheckOptions) => Promise<CheckedAvatar>;

/**
 * The faults that are accepted: at most a surface looks different, and known exporters of avatars make them. These are
 * bounds that are rounded otherwise, normals and weights that are slightly off their length, and a stride where none is
 * needed, which three.js reads correctly. Extensions that the validator does not know, such as VRM's, are accepted too.
 */
const acceptedFaults = [
  'ACCESSOR_MIN_MISMATCH',
  'ACCESSOR_MAX_MISMATCH',
  'ACCESSOR_VECTOR3_NON_UNIT',
  'ACCESSOR_WEIGHTS_NON_NORMALIZED',
  'ACCESSOR_INVALID_SIGN',
  'SKIN_IBM_ACCESSOR_WITH_BYTESTRIDE',
  'ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE',
  'UNSUPPORTED_EXTENSION',
];
/** Animations are not read, because poses move the avatar. */
const unread = /^\/animations(\/|$)/;
/** A node may have an empty list of children. */
const mayBeEmpty = /^\/nodes\/\d+\/children$/;
const information = 2;

/**
 * Returns the faults that the Khronos validator finds in a GLB file, a sentence each, at most twenty; empty: it is
 * valid.
 */
export async function gltfFaults(bytes: Uint8Array): Promise<readonly string[]> {
  const { issues } = await validateBytes(bytes, {
    format: 'glb',
    writeTimestamp: false,
    severityOverrides: Object.fromEntries(acceptedFaults.map((code) => [code, information])),
    maxIssues: 2000,
  });
  return issues.messages
    .filter(({ severity, pointer = '' }) => severity === 0 && !unread.test(pointer))
    .filter(({ code, pointer = '' }) => code !== 'EMPTY_ENTITY' || !mayBeEmpty.test(pointer))
    .slice(0, 20)
    .map(({ message, pointer }) => (pointer ? `${pointer}: ${message}` : message));
}

/** Checks a file on the calling thread. */
export const checkAvatar: AvatarCheck = async (given, { name, supportedCompressions, limits = avatarLimits }) => {
  const bytes = await convertToGlb(given, name, 'body');
  const file = new Uint8Array(bytes);
  const usedCompressions = inspectAvatar(file, name, supportedCompressions, limits);
  const faults = await gltfFaults(file).catch((error: unknown) => {
    throw new Error(`${name}: could not be checked (${reasonOf(error)})`);
  });
  if (faults.length > 0) throw new Error(`${name}: not valid glTF (${faults[0]})`);
  return { name, file: new Blob([bytes]), usedCompressions, hash: await sha256Base64Url(bytes) };
};
