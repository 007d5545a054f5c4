import type { BoneName } from '../../../src/threepoint/core/humanoid/bones';

/** What a file calls a bone. */
export type NameOf = (bone: BoneName) => string;

/** A name by the words of VRM's: which side, which bone, and for fingers which phalanx from the palm. */
function words(bone: BoneName) {
  const [, side = '', rest = ''] = /^(left|right)?(.*)$/.exec(bone) ?? [];
  const [, finger, phalanx] = /^(Thumb|Index|Middle|Ring|Little)(.*)$/.exec(rest) ?? [];
  const order = finger === 'Thumb' ? ['Metacarpal', 'Proximal', 'Distal'] : ['Proximal', 'Intermediate', 'Distal'];
  return { side, rest, finger, number: phalanx ? order.indexOf(phalanx) + 1 : 0 };
}

const table =
  (
    centre: Record<string, string>,
    limbs: Record<string, string>,
    sides: readonly [string, string],
    finger: (side: string, finger: string, number: number) => string,
  ): NameOf =>
  (bone) => {
    const { side, rest, finger: which, number } = words(bone);
    if (!side) return centre[rest] as string;
    const sign = side === 'left' ? sides[0] : sides[1];
    return which ? finger(sign, which, number) : (limbs[rest] as string).replace('$', sign);
  };
const pinky = (finger: string) => (finger === 'Little' ? 'Pinky' : finger);
export const mixamo = (prefix: string): NameOf => {
  const named = table(
    { hips: 'Hips', spine: 'Spine', chest: 'Spine1', upperChest: 'Spine2', neck: 'Neck', head: 'Head' },
    {
      ...{ Shoulder: '$Shoulder', UpperArm: '$Arm', LowerArm: '$ForeArm', Hand: '$Hand' },
      ...{ UpperLeg: '$UpLeg', LowerLeg: '$Leg', Foot: '$Foot', Toes: '$ToeBase' },
    },
    ['Left', 'Right'],
    (side, finger, number) => `${side}Hand${pinky(finger)}${number}`,
  );
  return (bone) => prefix + named(bone);
};
const blender = (prefix: string, centre: Record<string, string>): NameOf => {
  const named = table(
    centre,
    {
      ...{ Shoulder: 'shoulder.$', UpperArm: 'upper_arm.$', LowerArm: 'forearm.$', Hand: 'hand.$' },
      ...{ UpperLeg: 'thigh.$', LowerLeg: 'shin.$', Foot: 'foot.$', Toes: 'toe.$' },
    },
    ['L', 'R'],
    (side, finger, number) =>
      finger === 'Thumb' ? `thumb.0${number}.${side}` : `f_${pinky(finger).toLowerCase()}.0${number}.${side}`,
  );
  return (bone) => prefix + named(bone);
};
const unreal = (spine: readonly [string, string, string]): NameOf =>
  table(
    { hips: 'pelvis', spine: spine[0], chest: spine[1], upperChest: spine[2], neck: 'neck_01', head: 'head' },
    {
      ...{ Shoulder: 'clavicle_$', UpperArm: 'upperarm_$', LowerArm: 'lowerarm_$', Hand: 'hand_$' },
      ...{ UpperLeg: 'thigh_$', LowerLeg: 'calf_$', Foot: 'foot_$', Toes: 'ball_$' },
    },
    ['l', 'r'],
    (side, finger, number) => `${pinky(finger).toLowerCase()}_0${number}_${side}`,
  );
const reallusion = table(
  {
    ...{ hips: 'CC_Base_Hip', spine: 'CC_Base_Waist', chest: 'CC_Base_Spine01', upperChest: 'CC_Base_Spine02' },
    ...{ neck: 'CC_Base_NeckTwist01', head: 'CC_Base_Head' },
  },
  {
    ...{ Shoulder: 'CC_Base_$_Clavicle', UpperArm: 'CC_Base_$_Upperarm', LowerArm: 'CC_Base_$_Forearm' },
    ...{ Hand: 'CC_Base_$_Hand', UpperLeg: 'CC_Base_$_Thigh', LowerLeg: 'CC_Base_$_Calf' },
    ...{ Foot: 'CC_Base_$_Foot', Toes: 'CC_Base_$_ToeBase' },
  },
  ['L', 'R'],
  (side, finger, number) =>
    `CC_Base_${side}_${finger === 'Little' ? 'Pinky' : finger === 'Middle' ? 'Mid' : finger}${number}`,
);
export const vroid = table(
  {
    ...{ hips: 'J_Bip_C_Hips', spine: 'J_Bip_C_Spine', chest: 'J_Bip_C_Chest' },
    ...{ upperChest: 'J_Bip_C_UpperChest', neck: 'J_Bip_C_Neck', head: 'J_Bip_C_Head' },
  },
  {
    ...{ Shoulder: 'J_Bip_$_Shoulder', UpperArm: 'J_Bip_$_UpperArm', LowerArm: 'J_Bip_$_LowerArm' },
    ...{ Hand: 'J_Bip_$_Hand', UpperLeg: 'J_Bip_$_UpperLeg', LowerLeg: 'J_Bip_$_LowerLeg' },
    ...{ Foot: 'J_Bip_$_Foot', Toes: 'J_Bip_$_ToeBase' },
  },
  ['L', 'R'],
  (side, finger, number) => `J_Bip_${side}_${finger}${number}`,
);
const biped = table(
  {
    ...{ hips: 'Bip01 Pelvis', spine: 'Bip01 Spine', chest: 'Bip01 Spine1', upperChest: 'Bip01 Spine2' },
    ...{ neck: 'Bip01 Neck', head: 'Bip01 Head' },
  },
  {
    ...{ Shoulder: 'Bip01 $ Clavicle', UpperArm: 'Bip01 $ UpperArm', LowerArm: 'Bip01 $ Forearm' },
    ...{ Hand: 'Bip01 $ Hand', UpperLeg: 'Bip01 $ Thigh', LowerLeg: 'Bip01 $ Calf' },
    ...{ Foot: 'Bip01 $ Foot', Toes: 'Bip01 $ Toe0' },
  },
  ['L', 'R'],
  (side, finger, number) =>
    `Bip01 ${side} Finger${['Thumb', 'Index', 'Middle', 'Ring', 'Little'].indexOf(finger)}${number > 1 ? number - 1 : ''}`,
);
const metarig = {
  ...{ hips: 'spine', spine: 'spine.001', chest: 'spine.002', upperChest: 'spine.003' },
  ...{ neck: 'spine.004', head: 'spine.006' },
};
const sketchfab: NameOf = (bone) => `${mixamo('mixamorig:')(bone)}_0${bone.length % 10}`;

/** What programs call bones, by the program. */
export const namings: readonly (readonly [string, NameOf])[] = [
  ['Mixamo', mixamo('mixamorig:')],
  ['Mixamo with a prefix of its own', mixamo('Character7:')],
  ['Mixamo by way of Sketchfab', sketchfab],
  ['Ready Player Me and Avaturn', mixamo('')],
  ['VRoid', vroid],
  ['Unreal 4', unreal(['spine_01', 'spine_02', 'spine_03'])],
  ['Unreal 5', unreal(['spine_01', 'spine_03', 'spine_05'])],
  ['Rigify’s deform bones', blender('DEF-', metarig)],
  ['Rigify’s metarig', blender('', metarig)],
  ['Character Creator', reallusion],
  ['3ds Max’s Biped', biped],
  ['VRM’s own names', (bone) => bone],
];
