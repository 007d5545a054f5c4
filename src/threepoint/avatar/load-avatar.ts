import { type VRM, VRMLoaderPlugin, VRMUtils } from '@pixiv/three-vrm';
import type { Object3D } from 'three';
import { type GLTF, GLTFLoader, type GLTFLoaderPlugin, type GLTFParser } from 'three/addons/loaders/GLTFLoader.js';
import { reasonOf } from '../core/errors/reasons';
import type { BoneMap } from '../core/humanoid/bones';
import { betweenFrames } from './between-frames';
import { blobBufferViews } from './file/blob-buffer-views';
import type { CheckedAvatar } from './file/check-avatar';
import { convertToGlb } from './file/convert-to-glb';
import { removeInvalidExpressionBinds } from './file/expression-binds';
import { readGlbChunks } from './file/glb-chunks';
import { inspectAvatar } from './file/inspect-avatar';
import { makeGeometryPlain } from './file/plain-geometry';
import { removeInvalidSprings } from './file/valid-springs';
import { restoreBindPose } from './humanoid/bind-pose';
import { assertNeededBones, boneNode } from './humanoid/needed-bones';
import { settleRest } from './humanoid/rest-pose';
import { setVrmBones } from './humanoid/write-bone-names';

/** A loaded avatar: VRM 0.x or 1.0, or another humanoid in rest pose. */
export interface LoadedAvatar {
  readonly name: string;
  readonly vrm: VRM;
  /** The index of each object's node in the file. */
  readonly nodeIndices: ReadonlyMap<Object3D, number>;
}

/** Functions that add a decoder to a GLTFLoader, by the name of the compression's extension. */
export type Decoders = Readonly<Record<string, (loader: GLTFLoader) => Promise<void>>>;

export interface ParseOptions {
  /** The bones of a humanoid, instead of those that a VRM states and that are found in other files. */
  readonly bones?: BoneMap | undefined;
  /** The decoders; without them compressed files are refused. */
  readonly decoders?: Decoders;
}

/**
 * Parses the bytes of a trusted file: glTF within `avatarLimits`, or FBX. Rejects with an Error that names the file.
 */
export async function parseAvatar(
  given: ArrayBuffer,
  name: string,
  { bones, decoders = {} }: ParseOptions = {},
): Promise<LoadedAvatar> {
  const bytes = await convertToGlb(given, name, 'body');
  const usedCompressions = inspectAvatar(new Uint8Array(bytes), name, Object.keys(decoders));
  return parseChecked({ bytes, usedCompressions, file: new Blob([bytes]) }, name, { bones, decoders });
}

/** Parses a file that has passed `checkAvatar`. */
export async function parseChecked(checked: Omit<CheckedAvatar, 'hash'>, name: string, options: ParseOptions = {}) {
  try {
    const { gltf, own } = await readScene(checked, name, options);
    // Files without a humanoid of their own need the matcher, which others do not load.
    const vrm = own ?? (await import('./humanoid/create-humanoid')).createHumanoid(gltf.scene, name, options.bones);
    settleRest(vrm, name);
    return { name, vrm, nodeIndices: nodeIndicesOf(gltf) } satisfies LoadedAvatar;
  } catch (error) {
    // three-vrm reads its extensions without a check.
    if (!(error instanceof TypeError || error instanceof RangeError)) throw error;
    throw new Error(`${name}: cannot be read as an avatar (its parts do not fit together)`, { cause: error });
  }
}

/** Reads the scene of a file in bind pose, and its VRM; undefined: it is no VRM. */
export async function readScene(
  { bytes, usedCompressions, file }: Omit<CheckedAvatar, 'hash'>,
  name: string,
  { bones, decoders = {} }: ParseOptions,
): Promise<{ readonly gltf: GLTF; readonly own: VRM | undefined }> {
  const loader = new GLTFLoader();
  for (const extension of usedCompressions) await decoders[extension]?.(loader);
  loader.register(withoutAnimations);
  loader.register(removeInvalidExpressionBinds);
  loader.register(removeInvalidSprings);
  loader.register((parser) => new VRMLoaderPlugin(parser));
  const chunks = readGlbChunks(new Uint8Array(bytes))!;
  loader.register(blobBufferViews(chunks.binary, file));
  const gltf = await loader
    .parseAsync(bones ? withVrmBones(chunks.json, bones, name) : chunks.json, '')
    .catch((error: unknown) => {
      throw new Error(`${name}: cannot be read as glTF (${reasonOf(error)})`);
    });
  await betweenFrames(makeGeometryPlain(gltf.scene));
  const own = gltf.userData.vrm as VRM | undefined;
  if (own) {
    assertNeededBones(name, (bone) => boneNode(own, bone) !== null);
    // VRM 0.x faces −Z at rest, 1.0 faces +Z: both are rotated to +Z.
    VRMUtils.rotateVRM0(own);
  } else restoreBindPose(gltf.scene);
  return { gltf, own };
}

/** Returns the JSON of a file in which a VRM states these bones. Throws a sentence that names the file. */
function withVrmBones(text: string, bones: BoneMap, name: string): string {
  const json = JSON.parse(text);
  try {
    return setVrmBones(json, bones) ? JSON.stringify(json) : text;
  } catch (error) {
    throw new Error(`${name}: ${reasonOf(error)}`);
  }
}

/** Leaves out animations, because poses move the avatar. */
const withoutAnimations = ({ json }: GLTFParser): GLTFLoaderPlugin => ({
  name: 'threepoint_animations',
  beforeRoot() {
    delete json.animations;
    return null;
  },
});

function nodeIndicesOf({ parser }: GLTF): ReadonlyMap<Object3D, number> {
  const indices = new Map<Object3D, number>();
  // three.js also keeps objects here that are not nodes of the file.
  const places: Iterable<[object, { readonly nodes?: number } | undefined]> = parser.associations;
  for (const [object, place] of places) {
    if (place?.nodes !== undefined && 'isObject3D' in object) indices.set(object as Object3D, place.nodes);
  }
  return indices;
}
