import { type VRM, VRMLoaderPlugin, VRMUtils } from '@pixiv/three-vrm';
import type { Object3D } from 'three';
import { type GLTF, GLTFLoader, type GLTFLoaderPlugin, type GLTFParser } from 'three/addons/loaders/GLTFLoader.js';
import { reasonOf } from '../core/errors/reasons';
import type { BoneMap } from '../core/humanoid/bones';
import { betweenFrames } from './between-frames';
import { viewsOfFile } from './file/blob-buffer-views';
import type { CheckedAvatar } from './file/check-avatar';
import { glbOfFile } from './file/convert-to-glb';
import { validExpressionBinds } from './file/expression-binds';
import { chunksOf } from './file/glb-chunks';
import { inspectAvatar } from './file/inspect-avatar';
import { makeGeometryPlain } from './file/plain-geometry';
import { restoreBindPose } from './humanoid/bind-pose';
import { boneNode, demandBones } from './humanoid/needed-bones';
import { settleRest } from './humanoid/rest-pose';
import { setVrmBones } from './humanoid/write-bone-names';

/** A loaded body (VRM 0.x or 1.0, or another humanoid), ready to be fitted, and its name. */
export interface LoadedAvatar {
  readonly name: string;
  readonly vrm: VRM;
  /** Returns the index of an object's node in the file. */
  readonly nodeIndices: ReadonlyMap<Object3D, number>;
}

/** Means to unpack what is compressed, by the name of the extension. */
export type Decoders = Readonly<Record<string, (loader: GLTFLoader) => Promise<void>>>;

export interface ParseOptions {
  /** The bones of a humanoid, instead of those that a VRM states and that are found in other files. */
  readonly bones?: BoneMap | undefined;
  /** The decoders; without them compressed files are refused. */
  readonly decoders?: Decoders;
}

/**
 * Parses the bytes of a file within `avatarLimits` that is known to be valid glTF, or FBX. Rejects with a sentence that
 * names the file.
 */
export async function parseAvatar(
  given: ArrayBuffer,
  name: string,
  { bones, decoders = {} }: ParseOptions = {},
): Promise<LoadedAvatar> {
  const bytes = await glbOfFile(given, name, 'body');
  const packed = inspectAvatar(new Uint8Array(bytes), name, Object.keys(decoders));
  return parseChecked({ bytes, packed, file: new Blob([bytes]) }, name, { bones, decoders });
}

/** Parses a file that has passed `checkAvatar`. */
export async function parseChecked(checked: ReadableAvatar, name: string, options: ParseOptions = {}) {
  const { gltf, own } = await readScene(checked, name, options);
  // Files without a humanoid of their own need the matcher, which others do not load.
  const vrm = own ?? (await import('./humanoid/create-humanoid')).humanoidOf(gltf.scene, name, options.bones);
  settleRest(vrm, name);
  return { name, vrm, nodeIndices: nodeIndicesOf(gltf) } satisfies LoadedAvatar;
}

/** A file that has passed `checkAvatar`. */
export type ReadableAvatar = Pick<CheckedAvatar, 'bytes' | 'packed' | 'file'>;

/** Reads the scene of a file, its bones as bound, and the VRM that it states; undefined: it is no VRM. */
export async function readScene(
  { bytes, packed, file }: ReadableAvatar,
  name: string,
  { bones, decoders = {} }: ParseOptions,
): Promise<{ readonly gltf: GLTF; readonly own: VRM | undefined }> {
  const loader = new GLTFLoader();
  for (const extension of packed) await decoders[extension]?.(loader);
  loader.register(withoutAnimations);
  loader.register(validExpressionBinds);
  loader.register((parser) => new VRMLoaderPlugin(parser));
  const chunks = chunksOf(new Uint8Array(bytes))!;
  loader.register(viewsOfFile(chunks.binary, file));
  const gltf = await loader
    .parseAsync(bones ? withVrmBones(chunks.json, bones, name) : chunks.json, '')
    .catch((error: unknown) => {
      throw new Error(`${name}: cannot be read as glTF (${reasonOf(error)})`);
    });
  await betweenFrames(makeGeometryPlain(gltf.scene));
  const own = gltf.userData.vrm as VRM | undefined;
  if (own) {
    demandBones(name, (bone) => boneNode(own, bone) !== null);
    // VRM 0.x faces −Z at rest, 1.0 faces +Z: from here on all face +Z.
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

/** Leaves out animations, which no one plays on a body that poses move. */
const withoutAnimations = ({ json }: GLTFParser): GLTFLoaderPlugin => ({
  name: 'threepoint_animations',
  beforeRoot() {
    delete json.animations;
    return null;
  },
});

function nodeIndicesOf({ parser }: GLTF): ReadonlyMap<Object3D, number> {
  const indices = new Map<Object3D, number>();
  // three.js keeps objects without a place in the file here too.
  const places: Iterable<[object, { readonly nodes?: number } | undefined]> = parser.associations;
  for (const [object, place] of places) {
    if (place?.nodes !== undefined && 'isObject3D' in object) indices.set(object as Object3D, place.nodes);
  }
  return indices;
}
