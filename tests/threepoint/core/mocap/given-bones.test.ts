import { type BoneMap, UnknownBonesError } from 'threepoint/core';
import { distance } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { type MocapSource, prepareMocap } from '../../../../src/threepoint/core/mocap/prepare-mocap';
import { finishWork } from '../../../../src/threepoint/core/motion/work';
import { goldenMocap, sourceOf } from './golden-mocap';
import { madeBvh } from './made-bvh';

const prepare = (source: MocapSource) => finishWork(prepareMocap(source));
const bvh = (text: string, bones?: BoneMap): MocapSource => ({
  ...{ format: 'bvh', name: 'wave.bvh', text },
  ...(bones && { bones }),
});

function refusalOf(source: MocapSource): UnknownBonesError {
  try {
    prepare(source);
  } catch (error) {
    if (error instanceof UnknownBonesError) return error;
    throw error;
  }
  throw new Error('expected the bones to be refused');
}

/** The greatest distance of a joint from that of another clip [mm]. */
function apart(source: MocapSource, expected: MocapSource): number {
  const [ours, theirs] = [source, expected].map((each) => prepare(each).clips[0]!.truth) as [
    Float32Array,
    Float32Array,
  ];
  expect(ours).toHaveLength(theirs.length);
  let most = 0;
  for (const [i, value] of ours.entries()) most = Math.max(most, Math.abs(value - theirs[i]!));
  return 1000 * most;
}

describe('a BVH whose names contradict its skeleton', () => {
  const plain = madeBvh();
  const text = madeBvh({ nameOf: (name) => name.replace('LeftHand', 'LeftKnee') });

  test('is refused with its joints at rest, and what was found of them', () => {
    const { message, joints, matched } = refusalOf(bvh(text));
    expect(message).toMatch(/^wave\.bvh: its bones could not be matched to a humanoid: .*no leftHand/);
    const byName = new Map(joints.map((joint) => [joint.name, joint]));
    expect(byName.get('LeftKnee')?.position.x).toBeCloseTo(3 + 14 + 28 + 25, 6);
    expect(joints[byName.get('LeftKnee')!.parent]?.name).toBe('LeftForeArm');
    expect(matched).toMatchObject({ hips: 'Hips', leftLowerArm: 'LeftForeArm', rightHand: 'RightHand' });
    expect(matched.leftHand).toBeUndefined();
  });

  test('is read like the plain file once its bones are mapped', () => {
    const { matched } = refusalOf(bvh(text));
    const bones = { ...matched, leftHand: 'LeftKnee' };
    expect(apart(bvh(text, bones), bvh(plain))).toBeLessThan(0.001);
    expect(prepare(bvh(text, bones)).bones.matched).toEqual(bones);
  });

  test.each<[string, BoneMap, RegExp]>([
    ['without a head', { head: undefined }, /^wave\.bvh: the map of its bones has no head$/],
    [
      'with a bone of another file',
      { leftHand: 'Paw' },
      /no joint “Paw”, which the map of its bones names as leftHand/,
    ],
  ] as unknown as [string, BoneMap, RegExp][])('refuses a map %s', (_, changed, sentence) => {
    const all = { ...refusalOf(bvh(text)).matched, leftHand: 'LeftKnee', ...changed };
    const bones = Object.fromEntries(Object.entries(all).filter(([, name]) => name !== undefined));
    expect(() => prepare(bvh(text, bones))).toThrow(sentence);
  });
});

test('the user’s map decides where the file’s own bones were found, sides included', () => {
  const { matched } = prepare(bvh(madeBvh())).bones;
  const swapped = Object.fromEntries(
    Object.entries(matched).map(([bone, name]) => [
      bone.replace(/^(left|right)/, (side) => (side === 'left' ? 'right' : 'left')),
      name,
    ]),
  );
  const read = prepare(bvh(madeBvh(), swapped));
  expect(read.bones.matched).toEqual(swapped);
});

test('the joints of a folded rest are the first frame’s, where they can be separated', () => {
  const golden = goldenMocap.find(({ motion }) => motion === 'folded_1.bvh')!;
  const { joints } = prepare(sourceOf(golden)).bones;
  const at = (name: string) => joints.find((joint) => joint.name === `bip_${name}`)!.position;
  expect(at('Head').y - at('Hips').y).toBeGreaterThan(0.3 * distance(at('Head'), at('LeftFoot')));
  expect(distance(at('LeftHand'), at('RightHand'))).toBeGreaterThan(0.5 * distance(at('Head'), at('LeftFoot')));
});

describe('an AMC whose skeleton has other names than the CMU database’s', () => {
  const golden = goldenMocap.find(({ motion }) => motion.endsWith('.amc'))!;
  const named = (name: string): string => (/^(root|lowerback|upperback|thorax)$/.test(name) ? name : `joint_${name}`);
  const bones = [...golden.files['11.asf']!.matchAll(/name (\w+)/g)].map(([, name]) => name!);
  const renamed = Object.fromEntries(
    Object.entries(golden.files).map(([file, text]) => [
      file,
      text.replace(new RegExp(`\\b(${bones.join('|')})\\b`, 'g'), named),
    ]),
  );
  test('is read by its structure', () => {
    expect(apart(sourceOf({ ...golden, files: renamed }), sourceOf(golden))).toBeLessThan(1);
  });

  test('is read by the user’s map', () => {
    const { matched } = prepare(sourceOf({ ...golden, files: renamed })).bones;
    const source = { ...sourceOf({ ...golden, files: renamed }), bones: { ...matched, leftHand: 'joint_lhand' } };
    expect(apart(source, sourceOf(golden))).toBeLessThan(1);
    expect(prepare(source).bones.matched.leftHand).toBe('joint_lhand');
  });
});
