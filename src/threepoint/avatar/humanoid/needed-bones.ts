import type { VRM } from '@pixiv/three-vrm';
import type { Object3D } from 'three';
import { type BoneMap, neededBones } from '../../core/humanoid/bones';

/** Throws an Error that names the file and the needed bones that are missing. */
export function assertNeededBones(name: string, has: (bone: (typeof neededBones)[number]) => boolean): void {
  const missing = neededBones.filter((bone) => !has(bone));
  if (missing.length > 0) throw new Error(`${name}: its humanoid has no ${missing.join(', ')}`);
}

/** Returns the node of a bone in the file. */
export const boneNode = (vrm: VRM, bone: keyof BoneMap): Object3D | null =>
  vrm.humanoid.getRawBoneNode(bone as Parameters<VRM['humanoid']['getRawBoneNode']>[0]);
