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
 * The errors of the validator that are accepted, because three.js reads what they are about. All others stop a file:
 * numbers that are not there, no numbers, or not of the form that a reader needs; nodes in a circle; skins and morph
 * targets without the vertices they move; broken pictures.
 */
const acceptedErrors = [
  // Bounds and hints are not used; a stride is read wherever it stands; sparse numbers may come in any order.
  ...['ACCESSOR_MIN_MISMATCH', 'ACCESSOR_MAX_MISMATCH'],
  ...['ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND', 'ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND'],
  'MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS',
  ...['ACCESSOR_USAGE_OVERRIDE', 'BUFFER_VIEW_TARGET_OVERRIDE'],
  ...['BUFFER_VIEW_INVALID_BYTE_STRIDE', 'SKIN_IBM_ACCESSOR_WITH_BYTESTRIDE', 'IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE'],
  ...['MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE', 'MESH_PRIMITIVE_ACCESSOR_UNALIGNED'],
  'ACCESSOR_SPARSE_INDICES_NON_INCREASING',
  // A surface may look different, at most.
  ...['ACCESSOR_VECTOR3_NON_UNIT', 'ACCESSOR_INVALID_SIGN', 'ACCESSOR_NON_CLAMPED'],
  ...['MESH_PRIMITIVE_TOO_FEW_TEXCOORDS', 'MESH_PRIMITIVE_NO_TANGENT_SPACE'],
  ...['MESH_PRIMITIVE_INVALID_ATTRIBUTE', 'MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY'],
  // Weights are normalised, those of one joint add up, and of a bone's matrix the first three rows count.
  ...['ACCESSOR_WEIGHTS_NON_NORMALIZED', 'ACCESSOR_JOINTS_INDEX_DUPLICATE', 'ACCESSOR_INVALID_IBM'],
  // The joints of a skin are found by themselves, and morph targets start at zero.
  ...['SKIN_SKELETON_INVALID', 'SKIN_NO_COMMON_ROOT'],
  ...['MESH_INVALID_WEIGHTS_COUNT', 'NODE_WEIGHTS_INVALID'],
  // Browsers find out the kind of a picture by themselves.
  ...['IMAGE_MIME_TYPE_INVALID', 'IMAGE_NON_ENABLED_MIME_TYPE', 'TEXTURE_INVALID_IMAGE_MIME_TYPE'],
  // Extensions that are declared otherwise, or unknown to the validator, such as VRM's.
  ...['UNSUPPORTED_EXTENSION', 'UNDECLARED_EXTENSION', 'UNUSED_EXTENSION_REQUIRED', 'NON_REQUIRED_EXTENSION'],
  'UNEXPECTED_EXTENSION_OBJECT',
  // Lists may be empty.
  'EMPTY_ENTITY',
];
/** What is not read: animations, because poses move the avatar, and cameras. */
const unread = /^\/(animations|cameras)(\/|$)/;
const information = 2;

/**
 * Returns the faults that the Khronos validator finds in a GLB file, a sentence each, at most twenty; empty: it is
 * valid.
 */
export async function gltfFaults(bytes: Uint8Array): Promise<readonly string[]> {
  const { issues } = await validateBytes(bytes, {
    format: 'glb',
    writeTimestamp: false,
    severityOverrides: Object.fromEntries(acceptedErrors.map((code) => [code, information])),
    maxIssues: 2000,
  });
  return issues.messages
    .filter(({ severity, pointer = '' }) => severity === 0 && !unread.test(pointer))
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
