import {
  VRM,
  VRMFirstPerson,
  type VRMHumanBoneName,
  type VRMHumanBones,
  VRMHumanoid,
  VRMLoaderPlugin,
  VRMUtils,
} from '@pixiv/three-vrm';
import type { Group, Object3D } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { reasonOf } from '../core/errors/reasons';
import { inspectAvatar } from './inspect-avatar';

/** Bones without which there is no upper body to move. */
const neededBones = [
  'hips',
  'spine',
  'head',
  'leftUpperArm',
  'leftLowerArm',
  'leftHand',
  'rightUpperArm',
  'rightLowerArm',
  'rightHand',
] as const;

/** VRM's names of bones, and what a file calls their nodes. */
export type BoneMap = Readonly<Partial<Record<VRMHumanBoneName | `${VRMHumanBoneName}`, string>>>;

/** A VRM (0.x or 1.0) ready to be fitted, and what to call it. */
export interface LoadedAvatar {
  readonly name: string;
  readonly vrm: VRM;
}

/**
 * A VRM from the bytes of a file that is not our own: within `avatarLimits`, and without faults that `validate` finds. Rejects with a
 * sentence that names the file.
 */
export async function loadAvatar(
  bytes: ArrayBuffer,
  name: string,
  validate: (bytes: Uint8Array) => Promise<readonly string[]>,
): Promise<LoadedAvatar> {
  const file = new Uint8Array(bytes);
  inspectAvatar(file, name);
  const faults = await validate(file).catch((error: unknown) => {
    throw new Error(`${name}: ${reasonOf(error)}`);
  });
  if (faults.length > 0) throw new Error(`${name}: not valid glTF (${faults[0]})`);
  return parseAvatar(bytes, name);
}

/** The same from a file that is known to be valid; bones: of a humanoid that is no VRM. */
export async function parseAvatar(bytes: ArrayBuffer, name: string, bones?: BoneMap): Promise<LoadedAvatar> {
  inspectAvatar(new Uint8Array(bytes), name);
  const loader = new GLTFLoader();
  loader.register((parser) => new VRMLoaderPlugin(parser));
  const gltf = await loader.parseAsync(bytes, '').catch((error: unknown) => {
    throw new Error(`${name}: no VRM or GLB file (${reasonOf(error)})`);
  });
  const vrm = bones ? humanoidOf(gltf.scene, bones, name) : (gltf.userData.vrm as VRM | undefined);
  if (!vrm?.humanoid) throw new Error(`${name}: no humanoid in it; a VRM 0.x or 1.0 avatar is needed`);
  const missing = neededBones.filter((bone) => !vrm.humanoid.getRawBoneNode(bone));
  if (missing.length > 0) throw new Error(`${name}: its humanoid has no ${missing.join(', ')}`);
  // VRM 0.x looks along −Z at rest, 1.0 along +Z: from here on all look along +Z.
  VRMUtils.rotateVRM0(vrm);
  return { name, vrm };
}

/** A VRM made of a scene whose nodes these bones name. Throws where a name is not in it. */
function humanoidOf(scene: Group, bones: BoneMap, name: string): VRM {
  const nodes = new Map<string, Object3D>();
  scene.traverse((node) => {
    // three.js rewrites names; the file's own is kept beside.
    for (const known of [node.name, node.userData.name]) if (typeof known === 'string') nodes.set(known, node);
  });
  const humanBones = Object.fromEntries(
    Object.entries(bones).map(([bone, called]) => {
      const node = nodes.get(called);
      if (!node) throw new Error(`${name}: bones.${bone}: no node is called “${called}”`);
      return [bone, { node }];
    }),
  ) as VRMHumanBones;
  const humanoid = new VRMHumanoid(humanBones);
  scene.add(humanoid.normalizedHumanBonesRoot);
  const meshes: { meshes: Object3D[]; type: 'auto' }[] = [];
  scene.traverse((node) => {
    if ('isMesh' in node) meshes.push({ meshes: [node], type: 'auto' });
  });
  const meta = {
    metaVersion: '1',
    name,
    authors: [],
    licenseUrl: '',
  } as unknown as VRM['meta'];
  return new VRM({ scene, meta, humanoid, firstPerson: new VRMFirstPerson(humanoid, meshes as never) });
}
