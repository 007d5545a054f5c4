import type { BoneName, SkeletonJoint } from 'threepoint/core';
import { lerp, type Vec3, vec3 } from 'threepoint/math';

/** The joints of a person of 1.72 m in T-pose, facing +Z [cm]; the left side. */
const places: Readonly<Record<string, readonly [number, number, number]>> = {
  ...{ root: [0, 0, 0], hips: [0, 95, 0], base: [0, 100, 0], top: [0, 142, -2] },
  ...{ neck: [0, 148, -2], head: [0, 158, 0], crown: [0, 178, 1], jaw: [0, 160, 5], eye: [3, 165, 8] },
  ...{ pelvis: [4, 92, 0], hip: [9, 90, 0], knee: [9, 48, 1], ankle: [9, 8, -2], ball: [9, 1, 11], toe: [9, 1, 18] },
  ...{ collar: [3, 140, -1], shoulder: [17, 141, -2], elbow: [45, 141, -3], wrist: [70, 141, -2], palm: [73, 141, -2] },
  ...{ thumb1: [73, 140, 2], thumb2: [76, 139, 5], thumb3: [79, 138, 7], thumb4: [82, 138, 9] },
  ...{ index1: [79, 141, 1], index2: [83, 141, 1], index3: [85, 141, 1], index4: [87, 141, 1] },
  ...{ middle1: [79, 141, -1], middle2: [84, 141, -1], middle3: [86, 141, -1], middle4: [89, 141, -1] },
  ...{ ring1: [79, 141, -3], ring2: [83, 141, -3], ring3: [85, 141, -3], ring4: [88, 141, -3] },
  ...{ little1: [78, 141, -5], little2: [81, 141, -5], little3: [83, 141, -5], little4: [85, 141, -5] },
};

/** A joint as text: `name/parent/place[/bone]`; `$` is the side, a place may be `a~b~share`. */
type Line = string;

export interface Rig {
  readonly name: string;
  readonly joints: readonly SkeletonJoint[];
  /** The index of the joint of every bone that a match finds. */
  readonly bones: Readonly<Partial<Record<BoneName, number>>>;
}

function placeOf(text: string, sign: number): Vec3 {
  const [from, to, share] = text.split('~') as [string, string?, string?];
  const at = (name: string): Vec3 => {
    const [x, y, z] = places[name]!;
    return vec3(sign * x, y, z);
  };
  return to === undefined ? at(from) : lerp(at(from), at(to), Number(share));
}

const fingerWords = ['thumb', 'index', 'middle', 'ring', 'little'] as const;

/** The lines of five fingers of three joints, by the names that a program gives them. */
const fingers = (hand: string, nameOf: (finger: string, i: number) => string, joints = 3): readonly Line[] =>
  fingerWords.flatMap((finger) =>
    Array.from({ length: joints }, (_, k) => {
      const bones = finger === 'thumb' ? ['Metacarpal', 'Proximal', 'Distal'] : ['Proximal', 'Intermediate', 'Distal'];
      const bone = bones[k] ? `${finger[0]!.toUpperCase()}${finger.slice(1)}${bones[k]}` : '';
      return `${nameOf(finger, k + 1)}/${k === 0 ? hand : nameOf(finger, k)}/${finger}${k + 1}/${bone}`;
    }),
  );

function rig(name: string, sides: readonly [string, string], centre: readonly Line[], side: readonly Line[]): Rig {
  const joints: SkeletonJoint[] = [];
  const bones: Partial<Record<BoneName, number>> = {};
  const indices = new Map<string, number>();
  const put = (line: Line, word: string, sign: number, prefix: string) => {
    const [own, parent, place, bone] = line.replaceAll('$', word).split('/') as [string, string, string, string?];
    indices.set(own, joints.length);
    if (bone)
      bones[(prefix === '' ? bone : prefix + bone[0]!.toUpperCase() + bone.slice(1)) as BoneName] = joints.length;
    joints.push({ name: own, parent: indices.get(parent) ?? -1, position: placeOf(place, sign) });
  };
  for (const line of centre) put(line, '', 1, '');
  for (const line of side) put(line, sides[0], 1, 'left');
  for (const line of side) put(line, sides[1], -1, 'right');
  return { name, joints, bones };
}

/** A trunk of joints by their names, hips first, then the spine, neck and head. */
const trunk = (hips: string, spine: readonly string[], neck: readonly string[], head: string): readonly Line[] => {
  const bones =
    spine.length === 1
      ? ['spine']
      : spine.length === 2
        ? ['spine', 'chest']
        : spine.map((_, i) =>
            i === 0 ? 'spine' : i === spine.length - 1 ? 'upperChest' : i === spine.length >> 1 ? 'chest' : '',
          );
  const above = [hips, ...spine, ...neck];
  return [
    `${hips}//hips/hips`,
    ...spine.map((name, i) => `${name}/${above[i]}/base~top~${i / Math.max(1, spine.length - 1 || 1)}/${bones[i]}`),
    ...neck.map(
      (name, i) => `${name}/${above[1 + spine.length - 1 + i]}/neck~head~${i / neck.length}/${i === 0 ? 'neck' : ''}`,
    ),
    `${head}/${above.at(-1)}/head/head`,
  ];
};

/** Limbs of plain joints by their names; an empty name is left out. */
function limbs(chest: string, hips: string, arm: readonly string[], leg: readonly string[]): readonly Line[] {
  const lines: Line[] = [];
  const add = (from: string, names: readonly string[], at: readonly string[], bones: readonly string[]) => {
    let parent = from;
    for (const [i, name] of names.entries()) {
      if (name === '') continue;
      lines.push(`${name}/${parent}/${at[i]}/${bones[i] ?? ''}`);
      parent = name;
    }
  };
  add(chest, arm, ['collar', 'shoulder', 'elbow', 'wrist', 'palm'], ['shoulder', 'upperArm', 'lowerArm', 'hand']);
  add(hips, leg, ['hip', 'knee', 'ankle', 'ball', 'toe'], ['upperLeg', 'lowerLeg', 'foot', 'toes']);
  return lines;
}

const pinky = (finger: string): string => (finger === 'little' ? 'pinky' : finger);
const capital = (word: string): string => word[0]!.toUpperCase() + word.slice(1);

const mixamoLimbs = (prefix: string, chest: string): readonly Line[] =>
  limbs(
    chest,
    `${prefix}Hips`,
    ['Shoulder', 'Arm', 'ForeArm', 'Hand'].map((part) => `${prefix}$${part}`),
    ['UpLeg', 'Leg', 'Foot', 'ToeBase', 'Toe_End'].map((part) => `${prefix}$${part}`),
  );
const words = ['Left', 'Right'] as const;
const letters = ['L', 'R'] as const;
const small = ['l', 'r'] as const;

/** Skeletons as programs and packs write them. */
export const rigs: readonly Rig[] = [
  rig(
    'Mixamo',
    words,
    [
      ...trunk(
        'mixamorig:Hips',
        ['mixamorig:Spine', 'mixamorig:Spine1', 'mixamorig:Spine2'],
        ['mixamorig:Neck'],
        'mixamorig:Head',
      ),
      'mixamorig:HeadTop_End/mixamorig:Head/crown',
    ],
    [
      ...mixamoLimbs('mixamorig:', 'mixamorig:Spine2'),
      ...fingers('mixamorig:$Hand', (finger, i) => `mixamorig:$Hand${capital(pinky(finger))}${i}`, 4),
    ],
  ),
  rig(
    'Unreal 5',
    small,
    [
      'root//root',
      ...trunk(
        'pelvis',
        ['spine_01', 'spine_02', 'spine_03', 'spine_04', 'spine_05'],
        ['neck_01', 'neck_02'],
        'head',
      ).map((line, i) => (i === 0 ? 'pelvis/root/hips/hips' : line)),
      'ik_foot_root/root/root',
      'ik_hand_root/root/root',
      'ik_hand_gun/ik_hand_root/root',
    ],
    [
      ...limbs(
        'spine_05',
        'pelvis',
        ['clavicle_$', 'upperarm_$', 'lowerarm_$', 'hand_$'],
        ['thigh_$', 'calf_$', 'foot_$', 'ball_$'],
      ),
      'upperarm_twist_01_$/upperarm_$/shoulder~elbow~0.33',
      'lowerarm_twist_01_$/lowerarm_$/elbow~wrist~0.66',
      'lowerarm_twist_02_$/lowerarm_$/elbow~wrist~0.33',
      'wrist_inner_$/lowerarm_$/elbow~wrist~0.98',
      'wrist_outer_$/lowerarm_$/elbow~wrist~0.98',
      'thigh_twist_01_$/thigh_$/hip~knee~0.5',
      'ik_foot_$/ik_foot_root/ankle',
      'ik_hand_$/ik_hand_gun/wrist',
      ...fingerWords.slice(1).map((finger) => `${pinky(finger)}_metacarpal_$/hand_$/palm~${finger}1~0.1`),
      ...fingers('hand_$', (finger, i) => `${pinky(finger)}_0${i}_$`).map((line) =>
        line.replace(/^(\w+)_01_\$\/hand_\$/, (all, finger) =>
          finger === 'thumb' ? all : `${finger}_01_$/${finger}_metacarpal_$`,
        ),
      ),
    ],
  ),
  rig(
    'Unity’s robot',
    words,
    ['Root//root', 'Hip/Root/hips/hips', 'Ribs/Hip/base~top~0.6/spine', 'Neck/Ribs/neck/neck', 'Head/Neck/head/head'],
    limbs(
      'Ribs',
      'Hip',
      ['$_Shoulder_Joint_01', '$_Upper_Arm_Joint_01', '$_Forearm_Joint_01', '$_Wrist_Joint_01'],
      ['$_Thigh_Joint_01', '$_Knee_Joint_01', '$_Ankle_Joint_01', '$_Toe_Joint_01'],
    ),
  ),
  rig(
    'Rigify',
    letters,
    trunk(
      'DEF-spine',
      ['DEF-spine.001', 'DEF-spine.002', 'DEF-spine.003'],
      ['DEF-spine.004', 'DEF-spine.005'],
      'DEF-spine.006',
    ).concat(['DEF-jaw/DEF-spine.006/jaw', 'DEF-forehead.L/DEF-spine.006/eye', 'DEF-forehead.R/DEF-spine.006/eye']),
    [
      'DEF-shoulder.$/DEF-spine.003/collar/shoulder',
      'DEF-upper_arm.$/DEF-shoulder.$/shoulder/upperArm',
      'DEF-upper_arm.$.001/DEF-upper_arm.$/shoulder~elbow~0.5',
      'DEF-forearm.$/DEF-upper_arm.$.001/elbow/lowerArm',
      'DEF-forearm.$.001/DEF-forearm.$/elbow~wrist~0.5',
      'DEF-hand.$/DEF-forearm.$.001/wrist/hand',
      ...fingers('DEF-hand.$', (finger, i) => `DEF-${finger === 'thumb' ? 'thumb' : `f_${pinky(finger)}`}.0${i}.$`),
      'DEF-pelvis.$/DEF-spine/pelvis',
      'DEF-thigh.$/DEF-spine/hip/upperLeg',
      'DEF-thigh.$.001/DEF-thigh.$/hip~knee~0.5',
      'DEF-shin.$/DEF-thigh.$.001/knee/lowerLeg',
      'DEF-shin.$.001/DEF-shin.$/knee~ankle~0.5',
      'DEF-foot.$/DEF-shin.$.001/ankle/foot',
      'DEF-toe.$/DEF-foot.$/ball/toes',
      'DEF-breast.$/DEF-spine.003/collar~shoulder~0.5',
    ],
  ),
  rig(
    'MakeHuman',
    letters,
    trunk(
      'root',
      ['spine05', 'spine04', 'spine03', 'spine02', 'spine01'],
      ['neck01', 'neck02', 'neck03'],
      'head',
    ).concat(['jaw/head/jaw/jaw']),
    [
      'clavicle.$/spine01/collar/shoulder',
      'shoulder01.$/clavicle.$/collar~shoulder~0.8',
      'upperarm01.$/shoulder01.$/shoulder/upperArm',
      'upperarm02.$/upperarm01.$/shoulder~elbow~0.5',
      'lowerarm01.$/upperarm02.$/elbow/lowerArm',
      'lowerarm02.$/lowerarm01.$/elbow~wrist~0.5',
      'wrist.$/lowerarm02.$/wrist/hand',
      ...fingers('wrist.$', (finger, i) => `finger${fingerWords.indexOf(finger as 'thumb') + 1}-${i}.$`),
      'pelvis.$/root/pelvis',
      'upperleg01.$/pelvis.$/hip/upperLeg',
      'upperleg02.$/upperleg01.$/hip~knee~0.5',
      'lowerleg01.$/upperleg02.$/knee/lowerLeg',
      'lowerleg02.$/lowerleg01.$/knee~ankle~0.5',
      'foot.$/lowerleg02.$/ankle/foot',
      ...[1, 2, 3, 4, 5].flatMap((toe) => [
        `toe${toe}-1.$/foot.$/ball${toe === 1 ? '/toes' : ''}`,
        `toe${toe}-2.$/toe${toe}-1.$/toe`,
      ]),
    ],
  ),
  rig(
    'VRoid',
    letters,
    trunk(
      'J_Bip_C_Hips',
      ['J_Bip_C_Spine', 'J_Bip_C_Chest', 'J_Bip_C_UpperChest'],
      ['J_Bip_C_Neck'],
      'J_Bip_C_Head',
    ).concat(['J_Sec_Hair1_01/J_Bip_C_Head/crown', 'J_Sec_Hair2_01/J_Sec_Hair1_01/hips']),
    [
      ...limbs(
        'J_Bip_C_UpperChest',
        'J_Bip_C_Hips',
        ['J_Bip_$_Shoulder', 'J_Bip_$_UpperArm', 'J_Bip_$_LowerArm', 'J_Bip_$_Hand'],
        ['J_Bip_$_UpperLeg', 'J_Bip_$_LowerLeg', 'J_Bip_$_Foot', 'J_Bip_$_ToeBase'],
      ),
      ...fingers('J_Bip_$_Hand', (finger, i) => `J_Bip_$_${capital(finger)}${i}`),
      'J_Sec_$_SkirtFront1/J_Bip_C_Hips/hip',
      'J_Sec_$_SkirtFront2/J_Sec_$_SkirtFront1/hip~knee~0.5',
      'J_Sec_$_SkirtFront3/J_Sec_$_SkirtFront2/knee',
    ],
  ),
  rig(
    'Character Creator',
    letters,
    [
      'CC_Base_BoneRoot//root',
      'CC_Base_Hip/CC_Base_BoneRoot/hips/hips',
      'CC_Base_Pelvis/CC_Base_Hip/hips',
      'CC_Base_Waist/CC_Base_Hip/base/spine',
      'CC_Base_Spine01/CC_Base_Waist/base~top~0.5/chest',
      'CC_Base_Spine02/CC_Base_Spine01/top/upperChest',
      'CC_Base_NeckTwist01/CC_Base_Spine02/neck/neck',
      'CC_Base_NeckTwist02/CC_Base_NeckTwist01/neck~head~0.5',
      'CC_Base_Head/CC_Base_NeckTwist02/head/head',
    ],
    [
      ...limbs(
        'CC_Base_Spine02',
        'CC_Base_Pelvis',
        ['CC_Base_$_Clavicle', 'CC_Base_$_Upperarm', 'CC_Base_$_Forearm', 'CC_Base_$_Hand'],
        ['CC_Base_$_Thigh', 'CC_Base_$_Calf', 'CC_Base_$_Foot', 'CC_Base_$_ToeBase'],
      ),
      'CC_Base_$_UpperarmTwist01/CC_Base_$_Upperarm/shoulder~elbow~0.3',
      'CC_Base_$_ForearmTwist01/CC_Base_$_Forearm/elbow~wrist~0.3',
      ...fingers(
        'CC_Base_$_Hand',
        (finger, i) => `CC_Base_$_${finger === 'middle' ? 'Mid' : capital(pinky(finger))}${i}`,
      ),
    ],
  ),
  rig(
    '3ds Max’s Biped',
    letters,
    [
      'Bip01//hips',
      'Bip01 Pelvis/Bip01/hips/hips',
      'Bip01 Spine/Bip01 Pelvis/base/spine',
      'Bip01 Spine1/Bip01 Spine/top/chest',
      'Bip01 Neck/Bip01 Spine1/neck/neck',
      'Bip01 Head/Bip01 Neck/head/head',
      'Bip01 HeadNub/Bip01 Head/crown',
    ],
    [
      ...limbs(
        'Bip01 Neck',
        'Bip01 Pelvis',
        ['Bip01 $ Clavicle', 'Bip01 $ UpperArm', 'Bip01 $ Forearm', 'Bip01 $ Hand'],
        ['Bip01 $ Thigh', 'Bip01 $ Calf', 'Bip01 $ Foot', 'Bip01 $ Toe0'],
      ),
      ...fingers(
        'Bip01 $ Hand',
        (finger, i) => `Bip01 $ Finger${fingerWords.indexOf(finger as 'thumb')}${i > 1 ? i - 1 : ''}`,
      ),
    ],
  ),
  rig(
    'Xsens MVN and 100STYLE',
    words,
    trunk('Hips', ['Chest', 'Chest2', 'Chest3', 'Chest4'], ['Neck'], 'Head'),
    limbs('Chest4', 'Hips', ['$Collar', '$Shoulder', '$Elbow', '$Wrist'], ['$Hip', '$Knee', '$Ankle', '$Toe']),
  ),
  rig(
    'Rokoko',
    words,
    trunk('Hips', ['Spine1', 'Spine2', 'Spine3', 'Spine4'], ['Neck'], 'Head'),
    limbs('Spine4', 'Hips', ['$Shoulder', '$Arm', '$ForeArm', '$Hand'], ['$Thigh', '$Shin', '$Foot', '$Toe']),
  ),
  rig(
    'LAFAN1',
    words,
    trunk('Hips', ['Spine', 'Spine1', 'Spine2'], ['Neck'], 'Head'),
    limbs('Spine2', 'Hips', ['$Shoulder', '$Arm', '$ForeArm', '$Hand'], ['$UpLeg', '$Leg', '$Foot', '$Toe']),
  ),
  rig(
    'SMPL',
    letters,
    trunk('Pelvis', ['Spine1', 'Spine2', 'Spine3'], ['Neck'], 'Head'),
    limbs(
      'Spine3',
      'Pelvis',
      ['$_Collar', '$_Shoulder', '$_Elbow', '$_Wrist', '$_Hand'],
      ['$_Hip', '$_Knee', '$_Ankle', '$_Foot'],
    ),
  ),
  rig(
    'Kinect',
    words,
    trunk('SpineBase', ['SpineMid', 'SpineShoulder'], ['Neck'], 'Head'),
    limbs(
      'SpineShoulder',
      'SpineBase',
      ['', 'Shoulder$', 'Elbow$', 'Wrist$', 'Hand$'],
      ['Hip$', 'Knee$', 'Ankle$', 'Foot$'],
    ),
  ),
  rig(
    'Daz and Poser',
    small,
    trunk('hip', ['abdomen', 'chest'], ['neck'], 'head'),
    limbs('chest', 'hip', ['$Collar', '$Shldr', '$ForeArm', '$Hand'], ['$Thigh', '$Shin', '$Foot', '$Toe']),
  ),
  rig(
    'KayKit',
    small,
    [
      'root//root',
      'hips/root/hips/hips',
      'spine/hips/base/spine',
      'chest/spine/top/chest',
      'head/chest/neck/head',
      'kneeIK/root/root',
    ],
    [
      ...limbs(
        'chest',
        'hips',
        ['', 'upperarm.$', 'lowerarm.$', 'wrist.$', 'hand.$'],
        ['upperleg.$', 'lowerleg.$', 'foot.$', 'toes.$'],
      ),
      'handslot.$/hand.$/index1',
      'elbowIK.$/root/elbow',
      'handIK.$/root/wrist',
      'heelIK.$/root/ankle',
      'control-toe-roll.$/heelIK.$/ball',
      'control-heel-roll.$/control-toe-roll.$/ankle',
      'control-foot-roll.$/control-heel-roll.$/toe',
    ],
  ),
  rig(
    'Quaternius',
    letters,
    [
      'Bone//root',
      'Hips/Bone/hips/hips',
      'Abdomen/Hips/base/spine',
      'Torso/Abdomen/base~top~0.6/chest',
      'Neck/Torso/neck/neck',
      'Head/Neck/head/head',
    ],
    limbs('Torso', 'Hips', ['Shoulder$', 'UpperArm$', 'LowerArm$', 'Palm$'], ['UpperLeg$', 'LowerLeg$', 'Foot$', '']),
  ),
  rig(
    'Khronos’ Cesium man',
    letters,
    [
      'Skeleton_torso_joint_1//hips/hips',
      'Skeleton_torso_joint_2/Skeleton_torso_joint_1/base/spine',
      'torso_joint_3/Skeleton_torso_joint_2/top/chest',
      'Skeleton_neck_joint_1/torso_joint_3/neck/neck',
      'Skeleton_neck_joint_2/Skeleton_neck_joint_1/head/head',
    ],
    limbs(
      'torso_joint_3',
      'Skeleton_torso_joint_1',
      ['', 'Skeleton_arm_joint_$__4_', 'Skeleton_arm_joint_$__3_', 'Skeleton_arm_joint_$__2_'],
      ['leg_joint_$_1', 'leg_joint_$_2', 'leg_joint_$_3', 'leg_joint_$_5'],
    ),
  ),
  rig(
    'hips that hang under the spine',
    letters,
    [
      'skeleton//root',
      'torso/skeleton/base/spine',
      'hips/torso/hips/hips',
      'neck/torso/neck/neck',
      'head/neck/head/head',
    ],
    limbs('torso', 'hips', ['', 'upperarm.$', 'lowerarm.$', 'hand.$'], ['upperleg.$', 'lowerleg.$', 'foot.$', '']),
  ),
  rig(
    'feet that follow a control',
    letters,
    [
      'Bone//root',
      'Hips/Bone/hips/hips',
      'Torso/Hips/base~top~0.6/spine',
      'Neck/Torso/neck/neck',
      'Head/Neck/head/head',
      'LegPole/Bone/root',
    ],
    [
      ...limbs('Torso', 'Hips', ['Shoulder$', 'UpperArm$', 'LowerArm$', 'Palm$'], ['UpperLeg$', 'LowerLeg$']),
      'Foot$/Bone/ankle/foot',
    ],
  ),
];
