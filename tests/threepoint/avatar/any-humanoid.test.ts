import { Box3, Matrix4, type SkinnedMesh, Vector3 } from 'three';
import type { BoneName } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import { gltfFaults } from '../../../src/threepoint/avatar/file/check-avatar';
import { parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import { distance, type Vec3 } from '../../../src/threepoint/core/math/vec3';
import { builtRig, type RigOptions, rightArm } from './built-rig';
import { changed } from './glb';
import { mixamo, namings, vroid } from './rig-namings';
import { expectBody, hold, opened, skinAt } from './worn-body';

describe.each(namings)('a rig named as %s has them', (_, nameOf) => {
  test('is worn: wrists, fingers, palms and head where the wearer’s are', async () => {
    const body = await opened({ nameOf });
    expect(body.loaded.vrm.humanoid.getRawBoneNode('leftLittleDistal' as never)).not.toBeNull();
    expect(body.loaded.vrm.humanoid.getRawBoneNode('rightThumbMetacarpal' as never)).not.toBeNull();
    expect(body.loaded.vrm.humanoid.getRawBoneNode('upperChest' as never)).not.toBeNull();
    expectBody(body);
  });
});

test('a rig under names that mean nothing is worn by its structure', async () => {
  expectBody(await opened({ nameOf: (bone) => [...bone].map((letter) => letter.charCodeAt(0) % 7).join('x') }));
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

describe('a body of other proportions', () => {
  test('keeps its own neck and hanging shoulders; stretched out, it reaches as far as its wearer', async () => {
    const { avatar } = await opened({ nameOf: vroid });
    const wearer = 1.5; // the head joint of an adult of 1.70 m, about [m]
    const own = wearer / 1.42;
    const joints = avatar.jointPositions();
    const apart = (a: Vec3 | undefined, b: Vec3 | undefined) => distance(a as Vec3, b as Vec3);
    const ownNeck = () => expect(apart(joints.neck, joints.head)).toBeCloseTo(Math.hypot(0.08, 0.02) * own, 2);
    hold(avatar, 1);
    ownNeck();
    expect(apart(joints.leftUpperArm, joints.rightUpperArm)).toBeCloseTo(0.26 * own, 2);
    const { leftHand } = hold(avatar, 19.5);
    ownNeck();
    expect(apart(joints.leftUpperArm, joints.rightUpperArm)).toBeGreaterThan(0.26 * own + 0.02);
    expect(apart(joints.leftHand, leftHand!.position)).toBeLessThan(1e-3);
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
      const boxes = mesh!.geometry.getAttribute('position').count / 8;
      expect(index!.count, 'every box but the head’s').toBe(36 * (boxes - 1));
    }
  });
});

test('thick soles stand on the floor, in shoes of any height', async () => {
  for (const depth of [0, 0.08, 0.19]) {
    const more = ['left', 'right'].map((side) => ({
      called: `${side} sole`,
      parent: `${side}Foot` as BoneName,
      at: [side === 'left' ? 0.08 : -0.08, -depth, 0.02] as const,
    }));
    const { avatar } = await opened({ nameOf: mixamo('mixamorig:'), more });
    hold(avatar, 1);
    avatar.object.updateMatrixWorld(true);
    const bounds = new Box3().setFromObject(avatar.object, true);
    expect(bounds.min.y, `soles ${depth} m thick`).toBeCloseTo(0, 2);
  }
});

test('a rig with very short legs keeps them, and its trunk its length', async () => {
  const [hips, neck] = [0.92, 1.34];
  const height = (y: number) => (y < hips ? y * 0.43 : y < neck ? 0.4 + ((y - hips) * 0.94) / (neck - hips) : y);
  const body = await opened({ nameOf: vroid, place: (_, at) => void at.setY(height(at.y)) });
  expectBody(body);
  const { avatar } = body;
  hold(avatar, 1);
  const { hips: drawn, head, leftUpperLeg, leftLowerLeg } = avatar.jointPositions();
  expect(drawn!.y / head!.y).toBeCloseTo(0.4 / 1.42, 1);
  expect(distance(leftUpperLeg!, leftLowerLeg!) / head!.y).toBeCloseTo((0.43 * 0.39) / 1.42, 1);
});

describe('is refused with a sentence', () => {
  const refused = (options: RigOptions) => expect(parseAvatar(builtRig(options), 'person.glb')).rejects;

  test('a body that lacks a bone, by the bone’s name', async () => {
    await refused({ nameOf: vroid, without: ['head', 'neck'] }).toThrow(
      /person\.glb: its bones could not be matched to a humanoid: found .*; .*no head\. Map/,
    );
  });

  test('a body with one arm under meaningless names, with what was found and is needed', async () => {
    const nameOf = (bone: string) => `x${bone.length}${bone.at(-1)}q`;
    await refused({ nameOf, without: rightArm }).toThrow(
      /person\.glb: its bones could not be matched to a humanoid: .*loadAvatar\(source, \{bones:/,
    );
  });

  test('shapes without bones', async () => {
    const file = changed((json) => {
      json.skins = [];
      for (const node of json.nodes) {
        Object.assign(node, { name: `part ${node.name.length}` });
        for (const place of ['translation', 'rotation', 'scale', 'matrix', 'skin'])
          delete (node as unknown as Record<string, unknown>)[place];
      }
      for (const { attributes } of json.meshes.flatMap(({ primitives }) => primitives)) {
        delete attributes.JOINTS_0;
        delete attributes.WEIGHTS_0;
      }
      delete (json.extensions as { VRMC_vrm?: unknown }).VRMC_vrm;
    });
    await expect(parseAvatar(file, 'statue.glb')).rejects.toThrow(
      'statue.glb: it has no skeleton, only shapes; rig it',
    );
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
