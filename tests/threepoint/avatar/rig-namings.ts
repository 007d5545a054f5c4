import type { BoneName } from 'threepoint/core';
import { rigs } from '../core/humanoid/rigs';

/** What a file calls a bone. */
export type NameOf = (bone: BoneName) => string;

/** Returns the names of a program's skeleton; bones that it lacks have these. */
function namesOf(program: string, lacking: Partial<Record<BoneName, string>> = {}): NameOf {
  const found = rigs.find(({ name }) => name === program);
  if (!found) throw new Error(`rigs.ts: there is no skeleton of ${program}`);
  const { joints, bones } = found;
  return (bone) => lacking[bone] ?? joints[bones[bone] as number]!.name;
}

const mixamorig = namesOf('Mixamo');
export const mixamo =
  (prefix: string): NameOf =>
  (bone) =>
    mixamorig(bone).replace('mixamorig:', prefix);
export const vroid = namesOf('VRoid');
const rigify = namesOf('Rigify');

/** What programs call bones, by the program. */
export const namings: readonly (readonly [string, NameOf])[] = [
  ['Mixamo', mixamorig],
  ['Mixamo with a prefix of its own', mixamo('Character7:')],
  ['Mixamo by way of Sketchfab', (bone) => `${mixamorig(bone)}_0${bone.length % 10}`],
  ['Ready Player Me and Avaturn', mixamo('')],
  ['VRoid', vroid],
  ['Unreal 4', namesOf('Unreal 5', { chest: 'spine_02', upperChest: 'spine_03' })],
  ['Unreal 5', namesOf('Unreal 5')],
  ['Rigify’s deform bones', rigify],
  ['Rigify’s metarig', (bone) => rigify(bone).replace('DEF-', '')],
  ['Character Creator', namesOf('Character Creator')],
  ['3ds Max’s Biped', namesOf('3ds Max’s Biped', { upperChest: 'Bip01 Spine2' })],
  ['MakeHuman', namesOf('MakeHuman')],
  ['VRM’s own names', (bone) => bone],
];
