import { type VRM, VRMLoaderPlugin, VRMUtils } from '@pixiv/three-vrm';
import { BufferAttribute, type InterleavedBufferAttribute, type Object3D, type TypedArray } from 'three';
import { type GLTF, GLTFLoader, type GLTFLoaderPlugin, type GLTFParser } from 'three/addons/loaders/GLTFLoader.js';
import { reasonOf } from '../core/errors/reasons';
import type { GaitNetwork } from '../core/estimation/gait/gait';
import type { BoneMap } from '../core/humanoid/bones';
import { betweenFrames, type Steps } from './between-frames';
import { blobBufferViews } from './file/blob-buffer-views';
import type { CheckedAvatar } from './file/check-avatar';
import { convertToGlb } from './file/convert-to-glb';
import { inspectAvatar } from './file/inspect-avatar';
import { removeInvalidExpressionBinds, removeInvalidSprings } from './file/vrm-extensions';
import { restoreBindPose } from './humanoid/bind-pose';
import { assertNeededBones, boneNode } from './humanoid/needed-bones';
import { settleRest } from './humanoid/rest-pose';
import { setVrmBones } from './humanoid/write-bone-names';
import { meshesOf } from './scene-meshes';

/** A loaded avatar: VRM 0.x or 1.0, or another humanoid in rest pose. */
export interface LoadedAvatar {
  readonly name: string;
  readonly vrm: VRM;
  /** What was assumed of the file, a sentence each. */
  readonly notes: readonly string[];
  /** The network that moves the legs. */
  readonly gait: GaitNetwork;
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
  return parseChecked({ name, file: new Blob([bytes]), usedCompressions }, { bones, decoders });
}

/** Parses a file that has passed `checkAvatar`. */
export async function parseChecked(checked: Omit<CheckedAvatar, 'hash'>, options: ParseOptions = {}) {
  const { name } = checked;
  try {
    // The network has as many bytes as the rest of this code: it loads while the file is read.
    const [{ gltf, own }, { shippedGait: gait }] = await Promise.all([
      readScene(checked, options),
      import('../core/estimation/gait/shipped-gait'),
    ]);
    // Files without a humanoid of their own need the matcher, which others do not load.
    const { vrm, notes } = own
      ? { vrm: own, notes: [] }
      : (await import('./humanoid/create-humanoid')).createHumanoid(gltf.scene, name, options.bones);
    settleRest(vrm, name);
    return { name, vrm, notes, gait, nodeIndices: nodeIndicesOf(gltf) } satisfies LoadedAvatar;
  } catch (error) {
    // three-vrm reads its extensions without a check.
    if (!(error instanceof TypeError || error instanceof RangeError)) throw error;
    throw new Error(`${name}: cannot be read as an avatar (its parts do not fit together)`, { cause: error });
  }
}

/** Reads the scene of a file in bind pose, and its VRM; undefined: it is no VRM. */
export async function readScene(
  { name, file, usedCompressions }: Omit<CheckedAvatar, 'hash'>,
  { bones, decoders = {} }: ParseOptions,
): Promise<{ readonly gltf: GLTF; readonly own: VRM | undefined }> {
  const loader = new GLTFLoader();
  for (const extension of usedCompressions) await decoders[extension]?.(loader);
  loader.register(withoutAnimations);
  loader.register(removeInvalidExpressionBinds);
  loader.register(removeInvalidSprings);
  loader.register((parser) => new VRMLoaderPlugin(parser));
  const { json, binary } = await chunksOf(file);
  loader.register(blobBufferViews(binary));
  const gltf = await loader.parseAsync(bones ? withVrmBones(json, bones, name) : json, '').catch((error: unknown) => {
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

/** Returns the two chunks of a GLB file that has been inspected; only the text is read. */
async function chunksOf(file: Blob): Promise<{ readonly json: string; readonly binary: Blob }> {
  const header = new DataView(await file.slice(0, 20).arrayBuffer());
  const end = 20 + header.getUint32(12, true);
  return { json: await file.slice(20, end).text(), binary: file.slice(end + 8) };
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

type Attribute = BufferAttribute | InterleavedBufferAttribute;

/** Returns a copy of an interleaved attribute in a separate array. */
function deinterleaved(attribute: InterleavedBufferAttribute): BufferAttribute {
  const { count, itemSize, normalized, offset } = attribute;
  const { array, stride } = attribute.data;
  const plain = new (array.constructor as new (length: number) => TypedArray)(count * itemSize);
  for (let vertex = 0; vertex < count; vertex++) {
    const from = vertex * stride + offset;
    for (let item = 0; item < itemSize; item++) plain[vertex * itemSize + item] = array[from + item] as number;
  }
  return new BufferAttribute(plain, itemSize, normalized);
}

/**
 * Replaces interleaved attributes by separate arrays and adds missing indices to a scene's geometries, as the code that
 * cuts meshes into parts requires. Meshes that shared an attribute still share it.
 */
function* makeGeometryPlain(scene: Object3D): Steps<void> {
  const known = new Map<Attribute, BufferAttribute>();
  const plain = (attribute: Attribute): BufferAttribute => {
    if (!('isInterleavedBufferAttribute' in attribute)) return attribute;
    const made = known.get(attribute) ?? deinterleaved(attribute);
    known.set(attribute, made);
    return made;
  };
  for (const { geometry } of meshesOf(scene)) {
    yield;
    for (const [name, attribute] of Object.entries(geometry.attributes)) geometry.setAttribute(name, plain(attribute));
    for (const [name, targets] of Object.entries(geometry.morphAttributes)) {
      geometry.morphAttributes[name as 'position'] = (targets as Attribute[]).map(plain);
    }
    if (!geometry.index) {
      const { count } = geometry.getAttribute('position');
      geometry.setIndex(Array.from({ length: count }, (_, index) => index));
    }
  }
}
