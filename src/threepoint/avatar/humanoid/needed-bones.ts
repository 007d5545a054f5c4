import type { VRM } from '@pixiv/three-vrm';
import type { Object3D } from 'three';
import { type BoneMap, neededBones } from '../../core/humanoid/bones';

/** Throws a sentence that names the file and the bones that a body needs and this one lacks. */
export function demandBones(name: string, has: (bone: (typeof neededBones)[number]) => boolean): void {
  const missing = neededBones.filter((bone) => !has(bone));
  if (missing.length > 0) throw new Error(`${name}: its humanoid has no ${missing.join(', ')}`);
}

/** The node of a bone as the file has it. */
export const boneNode = (vrm: VRM, bone: keyof BoneMap): Object3D | null =>
  vrm.humanoid.getRawBoneNode(bone as Parameters<VRM['humanoid']['getRawBoneNode']>[0]);
