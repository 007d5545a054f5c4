import { type VRM, VRMLoaderPlugin, VRMUtils } from '@pixiv/three-vrm';
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

/** The same from a file that is known to be valid. */
export async function parseAvatar(bytes: ArrayBuffer, name: string): Promise<LoadedAvatar> {
  inspectAvatar(new Uint8Array(bytes), name);
  const loader = new GLTFLoader();
  loader.register((parser) => new VRMLoaderPlugin(parser));
  const gltf = await loader.parseAsync(bytes, '').catch((error: unknown) => {
    throw new Error(`${name}: no VRM or GLB file (${reasonOf(error)})`);
  });
  const vrm = gltf.userData.vrm as VRM | undefined;
  if (!vrm?.humanoid) throw new Error(`${name}: no humanoid in it; a VRM 0.x or 1.0 avatar is needed`);
  const missing = neededBones.filter((bone) => !vrm.humanoid.getRawBoneNode(bone));
  if (missing.length > 0) throw new Error(`${name}: its humanoid has no ${missing.join(', ')}`);
  // VRM 0.x looks along −Z at rest, 1.0 along +Z: from here on all look along +Z.
  VRMUtils.rotateVRM0(vrm);
  return { name, vrm };
}
