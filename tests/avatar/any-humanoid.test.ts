import { MeshoptEncoder } from 'meshoptimizer';
import { Matrix4, type SkinnedMesh, Vector3 } from 'three';
import { describe, expect, test } from 'vitest';
import { type Avatar, createAvatar } from '../../src/avatar/avatar';
import type { BoneName } from '../../src/avatar/bone-names';
import { decoders } from '../../src/avatar/decoders';
import { type LoadedAvatar, loadAvatar, parseAvatar } from '../../src/avatar/load-avatar';
import { gltfFaults } from '../../src/avatar/validate-gltf';
import { handBoneRotation } from '../../src/core/body/arm-rotations';
import { defaultCalibration } from '../../src/core/body/calibration';
import { createIk } from '../../src/core/estimation/estimators';
import { rotate } from '../../src/core/math/quat';
import { distance, down, type Vec3, vec3 } from '../../src/core/math/vec3';
import { actorFrame } from '../../src/core/tracking/actor-motion';
import type { TrackingFrame } from '../../src/core/tracking/tracking-frame';
import { poseOf } from '../core/estimation/drawn';
import { boxHalf, builtRig, type RigOptions } from './built-rig';

type NameOf = (bone: BoneName) => string;

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
const mixamo = (prefix: string): NameOf => {
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
const vroid = table(
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

const namings: readonly (readonly [string, NameOf])[] = [
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

async function opened(options: RigOptions): Promise<{ readonly loaded: LoadedAvatar; readonly avatar: Avatar }> {
  const loaded = await parseAvatar(builtRig(options), 'person.glb');
  const avatar = createAvatar(loaded);
  avatar.fitTo(defaultCalibration);
  return { loaded, avatar };
}

function skinOf(avatar: Avatar): SkinnedMesh {
  let found: SkinnedMesh | null = null;
  avatar.object.traverse((node) => {
    if ('isSkinnedMesh' in node && !node.name.includes('erase')) found = node as SkinnedMesh;
  });
  if (!found) throw new Error('a body without skin');
  return found;
}

/** The corners of the box of skin that is bound to a bone, as drawn, floor frame [m]. */
function skinAt({ loaded, avatar }: { loaded: LoadedAvatar; avatar: Avatar }, bone: BoneName): Vector3[] {
  avatar.object.updateMatrixWorld(true);
  const mesh = skinOf(avatar);
  const node = loaded.vrm.humanoid.getRawBoneNode(bone as never);
  const index = mesh.skeleton.bones.indexOf(node as never);
  if (index < 0) throw new Error(`no skin is bound to ${bone}`);
  return Array.from({ length: 8 }, (_, corner) =>
    mesh.getVertexPosition(index * 8 + corner, new Vector3()).applyMatrix4(mesh.matrixWorld),
  );
}

const middle = (corners: readonly Vector3[]): Vector3 =>
  corners.reduce((sum, corner) => sum.add(corner), new Vector3()).divideScalar(corners.length);

/** Arms stretched out, then hands before the chest: shows where skin lies in both. */
function hold(avatar: Avatar, seconds: number): TrackingFrame {
  const ik = createIk(defaultCalibration);
  const frame = actorFrame(seconds, defaultCalibration);
  for (let step = 0; step < 30; step++) avatar.apply(poseOf(ik, { ...frame, time: step / 30 }), step / 30);
  return frame;
}

/** What must be true of every body that is worn, from any file. */
function expectBody(body: { loaded: LoadedAvatar; avatar: Avatar }): void {
  for (const second of [1, 11.5, 20]) {
    const { leftHand, rightHand, head } = hold(body.avatar, second);
    for (const [side, hand] of [
      ['left', leftHand],
      ['right', rightHand],
    ] as const) {
      if (!hand) continue;
      expect(distance(middle(skinAt(body, `${side}Hand`)), hand.position), `${side} wrist`).toBeLessThan(1e-3);
      const knuckle = middle(skinAt(body, `${side}IndexProximal`));
      const along = new Vector3().subVectors(knuckle, hand.position as Vector3).normalize();
      const wrist = rotate(handBoneRotation(side, hand.orientation), vec3(side === 'left' ? -1 : 1, 0, 0));
      expect(along.dot(wrist as Vector3), `${side} index finger points as the hand does`).toBeGreaterThan(0.9);
      const little = middle(skinAt(body, `${side}LittleProximal`));
      const palm = rotate(hand.orientation, down);
      const across = new Vector3().subVectors(knuckle, little).normalize();
      expect(Math.abs(across.dot(palm as Vector3)), `${side} palm`).toBeLessThan(0.25);
    }
    const face = middle(skinAt(body, 'head'));
    expect(distance(face, head.position), 'head').toBeLessThan(0.2);
    const corners = skinAt(body, 'head');
    const size = corners[0]!.distanceTo(corners[1]!);
    expect(size, 'the head is as large as the wearer').toBeGreaterThan(boxHalf);
    expect(size).toBeLessThan(4 * boxHalf);
  }
}

describe.each(namings)('a rig named as %s has them', (_, nameOf) => {
  test('is worn: wrists, fingers, palms and head where the wearer’s are', async () => {
    const body = await opened({ nameOf });
    expect(body.loaded.vrm.humanoid.getRawBoneNode('leftLittleDistal' as never)).not.toBeNull();
    expect(body.loaded.vrm.humanoid.getRawBoneNode('rightThumbMetacarpal' as never)).not.toBeNull();
    expect(body.loaded.vrm.humanoid.getRawBoneNode('upperChest' as never)).not.toBeNull();
    expectBody(body);
  });
});

const turned = (axis: Point, degrees: number) =>
  new Matrix4().makeRotationAxis(new Vector3(...axis), (degrees / 180) * Math.PI);
type Point = readonly [number, number, number];
const scaled = (factor: number) => new Matrix4().makeScale(factor, factor, factor);

const rests: readonly (readonly [string, Partial<RigOptions>])[] = [
  ['with arms in an A', { armsDown: 50 }],
  ['with arms that hang', { armsDown: 80 }],
  ['in centimetres under an armature of 0.01', { unit: 100, root: scaled(0.01) }],
  ['in centimetres, as tall as a tower', { unit: 100 }],
  ['under a root scaled a hundredfold', { root: scaled(100) }],
  ['under a root scaled to a hundredth', { root: scaled(0.01) }],
  ['under a root scaled by −1', { root: scaled(-1) }],
  ['facing −Z', { root: turned([0, 1, 0], 180) }],
  ['facing +X', { root: turned([0, 1, 0], 90) }],
  ['lying on its back, as files with Z up are', { root: turned([1, 0, 0], -90) }],
  [
    'in an A, in centimetres and with Z up',
    { armsDown: 45, unit: 100, root: scaled(0.01).multiply(turned([1, 0, 0], 90)) },
  ],
  ['shown in the middle of a stride', { posed: true }],
  ['three metres from the origin', { root: new Matrix4().makeTranslation(3, 1, -2) }],
  ['with its vertex data interleaved', { interleaved: true }],
  ['without upperChest', { without: ['upperChest'] }],
  ['without shoulders', { without: ['leftShoulder', 'rightShoulder'] }],
  ['without toes', { without: ['leftToes', 'rightToes'] }],
  ['without a neck', { without: ['neck'] }],
  [
    'without legs',
    { without: ['UpperLeg', 'LowerLeg', 'Foot', 'Toes'].flatMap((bone) => [`left${bone}`, `right${bone}`]) },
  ],
  ['with 300 bones more', { moreBones: 300 }],
];

test.each(rests)('a rig %s is worn like any other', async (_, options) => {
  expectBody(await opened({ nameOf: mixamo('mixamorig:'), ...options }));
});

test('the faults of the files that tests build are none of the validator’s', async () => {
  const faults = await gltfFaults(new Uint8Array(builtRig({ nameOf: vroid, interleaved: true })));
  expect(faults.filter((fault) => !/min|max/i.test(fault))).toEqual([]);
});

/** The same file with the corners of its skin packed by meshopt, as exporters write it; `told`: how many it claims to be. */
async function packed(file: ArrayBuffer, told?: number): Promise<ArrayBuffer> {
  await MeshoptEncoder.ready;
  const bytes = Buffer.from(file);
  const length = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.toString('utf8', 20, 20 + length));
  const binary = bytes.subarray(28 + length);
  const view = json.bufferViews[0];
  const [count, byteStride] = [view.byteLength / 12, 12];
  const raw = new Uint8Array(binary.subarray(0, view.byteLength));
  const small = MeshoptEncoder.encodeGltfBuffer(raw, count, byteStride, 'ATTRIBUTES');
  const at = binary.length;
  const whole = Buffer.concat([binary.fill(0, 0, view.byteLength), small, Buffer.alloc((4 - (small.length % 4)) % 4)]);
  const extension = {
    buffer: 0,
    byteOffset: at,
    byteLength: small.length,
    byteStride,
    count: told ?? count,
    mode: 'ATTRIBUTES',
  };
  view.extensions = { EXT_meshopt_compression: extension };
  json.buffers[0].byteLength = whole.length;
  json.extensionsUsed = json.extensionsRequired = ['EXT_meshopt_compression'];
  const text = Buffer.from(JSON.stringify(json));
  const padded = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
  const head = Buffer.alloc(20);
  for (const [i, value] of [0x46546c67, 2, 28 + padded.length + whole.length, padded.length, 0x4e4f534a].entries()) {
    head.writeUInt32LE(value, i * 4);
  }
  const chunk = Buffer.alloc(8);
  chunk.writeUInt32LE(whole.length, 0);
  chunk.writeUInt32LE(0x004e4942, 4);
  return new Uint8Array(Buffer.concat([head, padded, chunk, whole])).buffer;
}

describe('a rig whose skin is packed by meshopt', () => {
  test('is worn like any other where the page has the means to unpack it, and refused where it has not', async () => {
    const file = await packed(builtRig({ nameOf: vroid }));
    await expect(parseAvatar(file, 'packed.glb')).rejects.toThrow(
      'packed.glb: is compressed (EXT_meshopt_compression)',
    );
    const loaded = await loadAvatar(file, 'packed.glb', async () => [], decoders);
    const avatar = createAvatar(loaded);
    avatar.fitTo(defaultCalibration);
    expectBody({ loaded, avatar });
  });

  test('is refused where it would unpack to more than an avatar may have', async () => {
    const bomb = await packed(builtRig({ nameOf: vroid }), 5e8);
    await expect(loadAvatar(bomb, 'bomb.glb', async () => [], decoders)).rejects.toThrow(
      /^bomb\.glb: 6000 million unpacked bytes/,
    );
  });
});

describe('a body of other proportions', () => {
  test('keeps its own neck and, with hanging arms, its own shoulders; stretched out, it reaches as far as its wearer', async () => {
    const { avatar } = await opened({ nameOf: vroid });
    const wearer = 1.5; // the head joint of an adult of 1.70 m, about [m]
    const own = wearer / 1.42;
    hold(avatar, 1);
    const joints = avatar.jointPositions();
    const apart = (a: Vec3 | undefined, b: Vec3 | undefined) => distance(a as Vec3, b as Vec3);
    expect(apart(joints.neck, joints.head)).toBeCloseTo(Math.hypot(0.08, 0.02) * own, 2);
    expect(apart(joints.leftUpperArm, joints.rightUpperArm)).toBeLessThan(0.34);
  });

  test('is as high as the top of its head, in metres and in centimetres', async () => {
    for (const unit of [1, 100]) {
      const body = await opened({ nameOf: vroid, unit });
      hold(body.avatar, 1);
      const top = Math.max(...skinAt(body, 'head').map(({ y }) => y));
      expect(Math.abs(body.avatar.height - top)).toBeLessThan(0.08);
    }
  });

  test('its first person is its body without the head, in one piece', async () => {
    for (const interleaved of [false, true]) {
      const { avatar } = await opened({ nameOf: vroid, interleaved });
      hold(avatar, 1);
      avatar.setFirstPerson(true);
      avatar.object.updateMatrixWorld(true);
      const own: SkinnedMesh[] = [];
      avatar.object.traverse((node) => {
        if ('isSkinnedMesh' in node && node.layers.isEnabled(0)) own.push(node as SkinnedMesh);
      });
      const [mesh] = own;
      expect(own).toHaveLength(1);
      const { index } = mesh!.geometry;
      let longest = 0;
      for (let i = 0; i < index!.count; i += 3) {
        const [a, b] = [0, 1].map((k) => mesh!.getVertexPosition(index!.getX(i + k), new Vector3()));
        longest = Math.max(longest, a!.distanceTo(b!));
      }
      // The boxes of its skin are small; a triangle across the room is a shattered one.
      expect(longest).toBeLessThan(0.2);
      expect(index!.count).toBe(((index!.count / 36) | 0) * 36);
    }
  });
});

describe('is refused with a sentence', () => {
  const refused = (options: RigOptions) => expect(parseAvatar(builtRig(options), 'person.glb')).rejects;

  test('a body that lacks a bone, by the bone’s name', async () => {
    await refused({ nameOf: vroid, without: ['leftHand', 'spine'] }).toThrow(
      'person.glb: its humanoid has no spine, leftHand',
    );
  });

  test('names that no naming has, with what was found and what to give', async () => {
    await refused({ nameOf: (bone) => `x${bone.length}${bone.at(-1)}q` }).toThrow(
      /person\.glb: no humanoid in it .*found: x4sq, .*Mixamo.*loadAvatar: \{bones:/,
    );
  });

  test('FBX, with the way to a GLB', async () => {
    const fbx = new TextEncoder().encode('Kaydara FBX Binary  \0 and more').buffer;
    const way = 'is an FBX file, which this page does not read; Blender makes a GLB of it';
    await expect(parseAvatar(fbx, 'soldier')).rejects.toThrow(way);
    await expect(parseAvatar(new TextEncoder().encode('; FBX 7.4.0').buffer, 'Soldier.FBX')).rejects.toThrow(way);
  });

  test('a scene scaled to nothing', async () => {
    await refused({ nameOf: vroid, rootScale: 0 }).toThrow('its joints lie all in one place');
  });

  test('joints that lie nowhere', async () => {
    await refused({ nameOf: vroid, root: scaled(Number.MAX_VALUE) }).toThrow(
      /person\.glb: the joint of \w+ lies nowhere/,
    );
  });

  test('joints that are no body’s', async () => {
    const file = parseAvatar(builtRig({ nameOf: vroid }), 'person.glb', {
      bones: {
        ...{ hips: 'J_Bip_C_Hips', spine: 'J_Bip_C_Spine', head: 'J_Bip_C_Head' },
        ...{ leftUpperArm: 'J_Bip_L_UpperArm', leftLowerArm: 'J_Bip_L_UpperArm', leftHand: 'J_Bip_L_Hand' },
        ...{ rightUpperArm: 'J_Bip_R_UpperArm', rightLowerArm: 'J_Bip_R_LowerArm', rightHand: 'J_Bip_R_Hand' },
      },
    });
    await expect(file).rejects.toThrow('its joints are no body’s: leftLowerArm lies 0 times as far from leftUpperArm');
  });
});
