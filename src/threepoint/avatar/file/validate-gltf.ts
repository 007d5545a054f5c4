import { validateBytes } from 'gltf-validator';

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
