import { type VRM, VRMLoaderPlugin, VRMUtils } from '@pixiv/three-vrm';
import type { Object3D } from 'three';
import { type GLTF, GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { reasonOf } from '../core/errors/reasons';
import { restoreBindPose } from './bind-pose';
import type { BoneMap } from './bone-names';
import { boneNode, demandBones, humanoidOf } from './humanoid';
import { inspectAvatar } from './inspect-avatar';
import { makeGeometryPlain } from './plain-geometry';
import { settleRest } from './rest-pose';

/** A body (VRM 0.x or 1.0, or a humanoid of another kind) ready to be fitted, and what to call it. */
export interface LoadedAvatar {
  readonly name: string;
  readonly vrm: VRM;
  /** Which node of the file an object is. */
  readonly nodeIndices: ReadonlyMap<Object3D, number>;
}

/** Means to unpack what is compressed, by the name of the extension. */
export type Decoders = Readonly<Record<string, (loader: GLTFLoader) => Promise<void>>>;

/** Finds faults of a file, each in a sentence. */
type Validate = (bytes: Uint8Array) => Promise<readonly string[]>;

export interface ParseOptions {
  /** Of a humanoid that is no VRM and whose names tell nothing. */
  readonly bones?: BoneMap | undefined;
  /** Without them compressed files are refused. */
  readonly decoders?: Decoders;
}

/**
 * A body from the bytes of a file that is not our own: within `avatarLimits`, and without faults that `validate` finds. Rejects with a
 * sentence that names the file.
 */
export const loadAvatar = (
  bytes: ArrayBuffer,
  name: string,
  validate: Validate,
  decoders: Decoders = {},
): Promise<LoadedAvatar> => read(bytes, name, { validate, decoders });

/** The same from a file that is known to be valid. */
export const parseAvatar = (bytes: ArrayBuffer, name: string, options: ParseOptions = {}): Promise<LoadedAvatar> =>
  read(bytes, name, options);

async function read(
  bytes: ArrayBuffer,
  name: string,
  { bones, decoders = {}, validate }: ParseOptions & { readonly validate?: Validate },
): Promise<LoadedAvatar> {
  const file = new Uint8Array(bytes);
  const packed = inspectAvatar(file, name, Object.keys(decoders));
  const faults = await validate?.(file).catch((error: unknown) => {
    throw new Error(`${name}: ${reasonOf(error)}`);
  });
  if (faults?.[0] !== undefined) throw new Error(`${name}: not valid glTF (${faults[0]})`);
  const loader = new GLTFLoader();
  for (const extension of packed) await decoders[extension]?.(loader);
  loader.register((parser) => new VRMLoaderPlugin(parser));
  const gltf = await loader.parseAsync(bytes, '').catch((error: unknown) => {
    throw new Error(`${name}: no VRM or GLB file (${reasonOf(error)})`);
  });
  makeGeometryPlain(gltf.scene);
  const own = bones ? undefined : (gltf.userData.vrm as VRM | undefined);
  if (own) {
    demandBones(name, (bone) => boneNode(own, bone) !== null);
    // VRM 0.x looks along −Z at rest, 1.0 along +Z: from here on all look along +Z.
    VRMUtils.rotateVRM0(own);
  } else restoreBindPose(gltf.scene);
  const vrm = own ?? humanoidOf(gltf.scene, name, bones);
  settleRest(vrm, name);
  return { name, vrm, nodeIndices: nodeIndicesOf(gltf) };
}

function nodeIndicesOf({ parser }: GLTF): ReadonlyMap<Object3D, number> {
  const indices = new Map<Object3D, number>();
  // three.js keeps objects without a place in the file here too.
  const places: Iterable<[object, { readonly nodes?: number } | undefined]> = parser.associations;
  for (const [object, place] of places) {
    if (place?.nodes !== undefined && 'isObject3D' in object) indices.set(object as Object3D, place.nodes);
  }
  return indices;
}
