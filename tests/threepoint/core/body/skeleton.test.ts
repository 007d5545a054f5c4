import fc from 'fast-check';
import { averageSkeleton, forwardKinematics, jointNames } from 'threepoint/core';
import { add, distance, fromAxisAngle, identity, length, type Quat, up, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { parentOf } from '../../../../src/threepoint/core/body/joints';
import { armBones, armLength } from '../../../../src/threepoint/core/body/skeleton';
import { evenly, rotation, seed, vector } from '../arbitraries';
import { boneStretch } from './bone-stretch';

const body = fc
  .tuple(evenly(0.95, 2.15), evenly(0.75, 1.1))
  .map(([eyeHeight, ratio]) => ({ eyeHeight, armSpan: eyeHeight * ratio }));

const pose = (rotationOf: (joint: string) => Quat) =>
  Object.fromEntries(jointNames.map((joint) => [joint, rotationOf(joint)])) as Record<
    (typeof jointNames)[number],
    Quat
  >;

describe('the calibrated skeleton', () => {
  test('parents come before their children', () => {
    for (const joint of jointNames) {
      const parent = parentOf[joint];
      if (parent !== null) expect(jointNames.indexOf(parent)).toBeLessThan(jointNames.indexOf(joint));
    }
  });

  test('stands upright at rest in T-pose: eyes at eye height, arms at span, face to −Z', () => {
    fc.assert(
      fc.property(body, (calibration) => {
        const skeleton = averageSkeleton(calibration);
        const joints = forwardKinematics(skeleton, {
          hipsPosition: skeleton.restOffsets.hips,
          localRotations: pose(() => identity),
        });
        const eyes = add(joints.head.position, skeleton.eyesInHead);
        expect(Math.abs(eyes.y / calibration.eyeHeight - 1)).toBeLessThan(0.03);
        expect(eyes.z).toBeLessThan(joints.head.position.z);
        const span = joints.rightHand.position.x - joints.leftHand.position.x;
        expect(Math.abs(span - calibration.armSpan)).toBeLessThan(1e-9);
        for (const joint of ['hips', 'spine', 'chest', 'upperChest', 'neck', 'head'] as const) {
          expect(joints[joint].position.x).toBe(0);
        }
        expect(joints.leftUpperArm.position.x).toBeLessThan(joints.leftShoulder.position.x);
      }),
      { seed },
    );
  });

  test('left and right are mirror images', () => {
    const { restOffsets } = averageSkeleton({ eyeHeight: 1.6, armSpan: 1.5 });
    for (const joint of ['Shoulder', 'UpperArm', 'LowerArm', 'Hand'] as const) {
      const { x, y, z } = restOffsets[`left${joint}`];
      expect(distance(vec3(-x, y, z), restOffsets[`right${joint}`])).toBeLessThan(1e-12);
    }
  });

  test('everything but the arms grows with the eye height alone, the arms with the span', () => {
    const small = averageSkeleton({ eyeHeight: 1, armSpan: 1 }).restOffsets;
    const tall = averageSkeleton({ eyeHeight: 2, armSpan: 2 }).restOffsets;
    for (const joint of jointNames) expect(length(tall[joint])).toBeCloseTo(2 * length(small[joint]), 12);
    const wide = averageSkeleton({ eyeHeight: 1, armSpan: 1.1 }).restOffsets;
    expect(wide.leftUpperArm).toEqual(small.leftUpperArm);
    expect(length(wide.leftLowerArm)).toBeGreaterThan(length(small.leftLowerArm));
  });

  test('a measured forearm divides the arm half-way from average to measure, and moves nothing else', () => {
    const told = { eyeHeight: 1.6, armSpan: 1.5, forearm: 0.25 };
    const average = averageSkeleton({ eyeHeight: 1.6, armSpan: 1.5 }).restOffsets;
    const { restOffsets } = averageSkeleton(told);
    for (const joint of jointNames) {
      if (!/LowerArm|Hand/.test(joint)) expect(restOffsets[joint]).toEqual(average[joint]);
    }
    for (const side of ['left', 'right'] as const) {
      const forearm = (length(average[`${side}Hand`]) + 0.25) / 2;
      expect(length(restOffsets[`${side}Hand`])).toBeCloseTo(forearm, 12);
      expect(length(restOffsets[`${side}LowerArm`])).toBeCloseTo(armLength(told) - forearm, 12);
    }
  });

  test('no measured forearm makes a bone vanish', () => {
    for (const forearm of [0, 0.05, 1, 9]) {
      const { upper, lower } = armBones({ eyeHeight: 1.6, armSpan: 1.5, forearm });
      expect(Math.min(upper, lower)).toBeGreaterThan(0.2);
    }
  });

  test('an arm never vanishes, however small the span', () => {
    expect(armLength({ eyeHeight: 1.6, armSpan: 0.1 })).toBeCloseTo(0.24, 9);
  });
});

describe('forward kinematics', () => {
  test('no rotation changes the length of a bone', () => {
    fc.assert(
      fc.property(body, fc.array(rotation, { minLength: 14, maxLength: 14 }), vector(5), (calibration, turns, hips) => {
        const skeleton = averageSkeleton(calibration);
        let next = 0;
        const joints = forwardKinematics(skeleton, { hipsPosition: hips, localRotations: pose(() => turns[next++]!) });
        expect(joints.hips.position).toEqual(hips);
        expect(boneStretch(joints, skeleton)).toBeLessThan(1e-9);
      }),
      { seed },
    );
  });

  test('turning the hips by a quarter to the left points the left arm backward', () => {
    const skeleton = averageSkeleton({ eyeHeight: 1.6, armSpan: 1.5 });
    const joints = forwardKinematics(skeleton, {
      hipsPosition: skeleton.restOffsets.hips,
      localRotations: pose((joint) => (joint === 'hips' ? fromAxisAngle(up, Math.PI / 2) : identity)),
    });
    expect(joints.leftHand.position.z).toBeGreaterThan(0.5);
    expect(Math.abs(joints.leftHand.position.x)).toBeLessThan(0.15);
  });
});
