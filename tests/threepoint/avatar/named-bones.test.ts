import { actorFrame, type BoneMap, type BoneName, defaultCalibration, UnknownBonesError } from 'threepoint/core';
import { distance, type Vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { createAvatar } from '../../../src/threepoint/avatar/avatar';
import { gltfFaults } from '../../../src/threepoint/avatar/file/check-avatar';
import { boneNode } from '../../../src/threepoint/avatar/humanoid/needed-bones';
import { withNamedBones } from '../../../src/threepoint/avatar/humanoid/write-bone-names';
import { type LoadedAvatar, parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import { createIk } from '../../../src/threepoint/core/estimation/estimators';
import { poseOf } from '../core/estimation/drawn';
import { builtRig, rightArm } from './built-rig';
import { changed } from './glb';

/** Names that no program gives: each bone's backwards. */
const backwards = (bone: string): string => [...bone].reverse().join('');
const bones: BoneMap = Object.fromEntries(
  [
    ...['hips', 'spine', 'chest', 'neck', 'head'],
    ...['left', 'right'].flatMap((side) => ['Shoulder', 'UpperArm', 'LowerArm', 'Hand'].map((part) => side + part)),
  ].map((bone) => [bone, backwards(bone)]),
);

const estimator = createIk(defaultCalibration);

/** Returns the joints of a body that stands as the built-in actor does. */
function posed(loaded: LoadedAvatar) {
  const avatar = createAvatar(loaded);
  avatar.setCalibration(defaultCalibration);
  avatar.setPose(poseOf(estimator, actorFrame(9.5, defaultCalibration)), 0);
  return structuredClone(avatar.jointPositions());
}

/** One place, but for rounding. */
const expectSame = (a: Vec3 | undefined, b: Vec3 | undefined) =>
  expect(a && b ? distance(a, b) : 'one of them is not drawn').toBeLessThan(1e-9);

/** Returns the error of a file whose bones cannot be matched by their names. */
async function refusalOf(file: ArrayBuffer): Promise<UnknownBonesError> {
  const error = await parseAvatar(file, 'person.glb').then(
    () => null,
    (reason: unknown) => reason,
  );
  if (!(error instanceof UnknownBonesError)) throw new Error(`expected an UnknownBonesError, not ${error}`);
  return error;
}

describe('a file whose bones match no humanoid', () => {
  test('is reported with its names, and with those that were matched', async () => {
    const unknown = await refusalOf(builtRig({ nameOf: backwards, without: rightArm }));
    const found = unknown.joints.map(({ name }) => name);
    expect(found).toContain('spih');
    expect(found).toContain('dnaHtfel');
    expect(Object.values(unknown.matched).every((name) => found.includes(name))).toBe(true);
    const oneHanded = await refusalOf(builtRig({ nameOf: (bone) => (bone === 'leftHand' ? 'leftToe' : bone) }));
    expect(oneHanded.message).toMatch(/^person\.glb: its bones could not be matched to a humanoid.*; no leftHand\./);
    expect(oneHanded.matched).toMatchObject({ hips: 'hips', rightHand: 'rightHand' });
    expect(oneHanded.confidence.hips).toBeGreaterThan(0.9);
    expect(oneHanded.joints.map(({ name }) => name)).toContain('leftToe');
  });

  test('is worn with a map, and without one once its bones are named', async () => {
    const file = builtRig({ nameOf: backwards });
    const named = await withNamedBones(file, bones);
    expect(await gltfFaults(new Uint8Array(named))).toEqual([]);
    const own = posed(await parseAvatar(file, 'person.glb', { bones }));
    const seen = posed(await parseAvatar(named, 'person.glb'));
    for (const joint of ['hips', 'head', 'leftHand', 'rightLowerArm'] as const) expectSame(seen[joint], own[joint]);
  });

  test('calls no bone by a name that another node has', async () => {
    const decoy = (bone: BoneName) =>
      bone === 'leftToes' ? 'Head' : bone === 'rightToes' ? 'left_hand' : backwards(bone);
    const seen = posed(await parseAvatar(await withNamedBones(builtRig({ nameOf: decoy }), bones), 'person.glb'));
    const own = posed(await parseAvatar(builtRig({ nameOf: backwards }), 'person.glb', { bones }));
    expectSame(seen.head, own.head);
    expectSame(seen.leftHand, own.leftHand);
  });

  test('may name something else as a bone: the map means the bone, for every viewer', async () => {
    const file = changed(
      (json) => {
        const [scene] = json.scenes as { nodes: number[] }[];
        json.nodes.push({ name: backwards('head'), translation: [0, 0.3, 0] });
        scene!.nodes.unshift(json.nodes.length - 1);
        // First in the list as well as in the scene.
        json.nodes.unshift(json.nodes.pop()!);
        const shift = (node: number) => (node === json.nodes.length - 1 ? 0 : node + 1);
        for (const each of json.nodes) if (each.children) each.children = each.children.map(shift);
        for (const skin of json.skins) skin.joints = skin.joints.map(shift);
        scene!.nodes = scene!.nodes.map(shift);
      },
      builtRig({ nameOf: backwards }),
    );
    const own = await parseAvatar(file, 'person.glb', { bones });
    const seen = await parseAvatar(await withNamedBones(file, bones), 'person.glb');
    for (const { vrm } of [own, seen]) expect(boneNode(vrm, 'head')).toHaveProperty('isBone', true);
    const { height } = createAvatar(await parseAvatar(builtRig({ nameOf: backwards }), 'person.glb', { bones }));
    expect(createAvatar(own).height).toBeCloseTo(height, 9);
    expect(createAvatar(seen).height).toBeCloseTo(height, 9);
  });

  test('cannot be named after what is not in it, nor can anything that is no GLB', async () => {
    const file = builtRig({ nameOf: backwards });
    await expect(withNamedBones(file, { hips: 'Bottom' })).rejects.toThrow('bones.hips: no node is called “Bottom”');
    await expect(withNamedBones(new ArrayBuffer(40), bones)).rejects.toThrow('no GLB file');
  });
});
