import { Quaternion, Vector3 } from 'three';
import { BVHLoader } from 'three/addons/loaders/BVHLoader.js';
import { distance, type Quat, type Vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { createSkeletonPose } from '../../../../src/threepoint/core/motion/imported-motion';
import { turnPoint, turnRotation } from '../../../../src/threepoint/core/motion/motion-bones';
import { type BvhMotion, poseBvh, readBvh } from '../../../../src/threepoint/core/motion/read-bvh';
import { finishWork } from '../../../../src/threepoint/core/motion/work';
import { writeBvh } from '../../../../src/threepoint/core/motion/write-bvh';
import { actingPerson, contortedPerson, rateHz, type Truth, textOf } from './moved-person';
import { playerOf } from './play-clip';

const people = { contorted: contortedPerson(), acting: actingPerson() };
const read = (text: string): BvhMotion => finishWork(readBvh(text));

/** The joint of a file as floor frame [m] against the truth. */
function expectJoint(truth: Truth, name: string, position: Vec3, rotation: Quat): void {
  const joint = truth.get(name);
  if (!joint) throw new Error(`no truth of ${name}`);
  expect(distance(turnPoint(position), joint.position), name).toBeLessThan(1e-3);
  if (joint.orientation) expect(turnRotation(rotation, { ...rotation })).toBeSameRotationAs(joint.orientation, 0.1);
}

describe.each(Object.entries(people))('the %s person in a BVH file', (_, { motion, truth }) => {
  test.each([
    ['m', 1],
    ['cm', 100],
  ] as const)('is read back by our reader within 1 mm and 0.1° (%s)', (unit, perMetre) => {
    const file = read(textOf(writeBvh(motion, { unit })));
    expect(file.frameCount).toBe(truth.length);
    expect(file.frameSeconds).toBeCloseTo(1 / rateHz, 8);
    const pose = createSkeletonPose(file.joints.length);
    let compared = 0;
    for (const [frame, joints] of truth.entries()) {
      poseBvh(file, frame, pose);
      for (const [i, { name }] of file.joints.entries()) {
        if (!joints.has(name)) continue;
        const { x, y, z } = pose.positions[i]!;
        expectJoint(joints, name, { x: x / perMetre, y: y / perMetre, z: z / perMetre }, pose.rotations[i]!);
        compared += 1;
      }
    }
    expect(compared).toBe(truth.length * (14 + 2 * 5 * 4));
  });

  test('is read back by three’s BVHLoader within 1 mm and 0.1°', () => {
    const { skeleton, clip } = new BVHLoader().parse(textOf(writeBvh(motion)));
    const root = skeleton.bones[0]!;
    const play = playerOf(root, clip);
    const at = { position: new Vector3(), rotation: new Quaternion(), scale: new Vector3() };
    for (const [frame, joints] of truth.entries()) {
      play(frame / rateHz);
      for (const { name, matrixWorld } of skeleton.bones) {
        if (!joints.has(name)) continue;
        matrixWorld.decompose(at.position, at.rotation, at.scale);
        const { x, y, z, w } = at.rotation;
        expectJoint(joints, name, at.position, { x, y, z, w });
      }
    }
  });
});

describe('a BVH file', () => {
  const text = textOf(writeBvh(people.acting.motion));

  test('rests in T-pose facing +Z, and says by joints without channels that legs are not measured', () => {
    const { joints } = read(text);
    const named = (name: string) => joints.find((joint) => joint.name === name)!;
    expect(named('hips').offset).toEqual({ x: 0, y: 0, z: 0 });
    expect(named('leftLowerArm').offset.x).toBeGreaterThan(0.2);
    expect(named('rightIndexProximal').offset.x).toBeLessThan(-0.05);
    expect(named('leftThumbMetacarpal').offset.z).toBeGreaterThan(0.01);
    for (const side of ['left', 'right']) {
      for (const part of ['UpperLeg', 'LowerLeg', 'Foot']) expect(named(`${side}${part}`).channels).toEqual([]);
    }
    expect(
      named('hips')
        .channels.slice(3)
        .map(({ axis }) => axis)
        .join(''),
    ).toBe('yxz');
  });

  test('is written in steps of some frames, so that others have their turn', () => {
    const shares = [...writeBvh(people.acting.motion)];
    expect(shares.length).toBeGreaterThan((2 * people.acting.truth.length) / 80);
    expect(shares).toEqual([...shares].sort((a, b) => a - b));
  });

  test('has the rate that is asked for', () => {
    const file = read(textOf(writeBvh(people.acting.motion, { rateHz: 30 })));
    expect(file.frameCount).toBe(Math.floor(people.acting.motion.times.at(-1)! * 30) + 1);
    expect(() => textOf(writeBvh(people.acting.motion, { rateHz: Number.NaN }))).toThrow(/rate of NaN Hz/);
  });

  const lines = text.split('\n');
  const motionAt = lines.indexOf('MOTION');
  const changed = (at: number, line: string) => lines.with(at, line).join('\n');
  const frame = motionAt + 3;
  test.each([
    ['nothing', '', /line 1, column 1: no BVH file/],
    ['prose', 'Dear Sir or Madam', /line 1, column 1: “Dear” is not known/],
    ['a hierarchy cut short', lines.slice(0, 20).join('\n'), /ends before its MOTION/],
    ['an unclosed joint', changed(motionAt - 1, ''), /the hierarchy is not closed/],
    ['one brace too many', changed(motionAt, '}'), /“}” closes nothing/],
    ['an offset of two numbers', changed(3, '\tOFFSET 1 2'), /line 4, column 2: OFFSET should be three numbers, has 2/],
    ['an offset that is none', changed(3, '\tOFFSET 1 two 3'), /line 4, column 11: “two” is no finite number/],
    [
      'a wrong count of channels',
      changed(4, '\tCHANNELS 7 Xposition'),
      /line 5, column 11: CHANNELS “7”, but 1 follow/,
    ],
    ['an unknown channel', changed(4, '\tCHANNELS 1 Xscale'), /line 5, column 13: channel “Xscale” is not known/],
    ['a frame cut short', changed(frame, '0 0 0'), new RegExp(`line ${frame + 1}, column 1: a frame has 3 numbers`)],
    [
      'a number that is none',
      changed(frame, lines[frame]!.replace(/^\S+/, 'NaN')),
      new RegExp(`line ${frame + 1}, column 1: “NaN”`),
    ],
    ['too few frames', lines.slice(0, -5).join('\n'), /Frames says \d+, but the file ends after/],
    ['too many frames', changed(motionAt + 1, 'Frames: 2'), /Frames says 2, but more follow/],
    [
      'a count that is none',
      changed(motionAt + 1, 'Frames: many'),
      new RegExp(`line ${motionAt + 2}, column 9: Frames should be a count`),
    ],
    ['a negative rate', changed(motionAt + 2, 'Frame Time: -1'), /Frame Time should be seconds, is “-1”/],
    ['no frames', lines.slice(0, frame).join('\n'), /ends without a frame/],
  ])('is refused for %s, with line and column', (_, nonsense, sentence) => {
    expect(() => read(nonsense)).toThrow(sentence);
  });

  test('with a million joints is refused before it fills the memory', () => {
    const many = `HIERARCHY\n${'JOINT a\n{\nOFFSET 0 0 0\n'.repeat(6000)}`;
    expect(() => read(many)).toThrow(/more than 5000 joints/);
  });

  test('reports how far it is read', () => {
    const shares = [...readBvh(text)];
    expect(shares.length).toBeGreaterThan(2);
    expect(shares).toEqual([...shares].sort((a, b) => a - b));
    expect(shares.at(-1)).toBeLessThanOrEqual(1);
  });
});
