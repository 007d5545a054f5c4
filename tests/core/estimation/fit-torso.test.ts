import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { forwardKinematics } from '../../../src/core/body/forward-kinematics';
import { estimatedJoints } from '../../../src/core/body/joints';
import { skeletonFromCalibration } from '../../../src/core/body/skeleton';
import { createEstimator } from '../../../src/core/estimation/estimators';
import { fromAxisAngle } from '../../../src/core/math/quat';
import { add, addScaled, copyVec3, distance, up, type Vec3, vec3 } from '../../../src/core/math/vec3';
import { cases } from '../../nightly';
import { evenly, seed } from '../arbitraries';
import { completedFrame, fitted, type Joints, poseOf } from './drawn';
import { standing, transformFrame } from './moving-person';

const calibration = { eyeHeight: 1.62, armSpan: 1.53 };
const skeleton = skeletonFromCalibration(calibration);
const shoulder = { left: vec3(-0.17, 1.41, 0.05), right: vec3(0.17, 1.41, 0.05) };
const hip = { left: vec3(-0.22, 0.85, -0.05), right: vec3(0.22, 0.85, -0.05) };
const trunk = ['leftUpperArm', 'rightUpperArm', 'neck', 'chest', 'hips'] as const;

const direction = fc
  .record({ yaw: evenly(-2.6, 2.6), pitch: evenly(-1.2, 1.2) })
  .map(({ yaw, pitch }) => vec3(Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), -Math.cos(yaw) * Math.cos(pitch)));
const standpoint = fc.record({ x: evenly(-2, 2), z: evenly(-2, 2), yaw: evenly(-3, 3) });

describe('hands that glide out of reach', () => {
  /** The furthest step [m] of shoulders, neck, chest and hips while hands glide by 1 mm a frame to these places, one after the other. */
  function largestStep(
    { x, z, yaw }: { readonly x: number; readonly z: number; readonly yaw: number },
    hands: (metres: number) => { readonly left: Vec3; readonly right: Vec3 },
    frames: number,
  ): number {
    const estimator = createEstimator('ik', calibration);
    const elsewhere = { position: vec3(x, 0, z), orientation: fromAxisAngle(up, yaw) };
    let before: readonly Vec3[] | null = null;
    let largest = 0;
    for (let i = 0; i < frames; i++) {
      const { left, right } = hands(i / 1000);
      const frame = { ...transformFrame(elsewhere, standing(calibration, left, right)), time: i / 60 };
      const joints: Joints = forwardKinematics(skeleton, poseOf(estimator, frame).body!);
      const now = trunk.map((joint) => copyVec3(joints[joint].position));
      before?.forEach((place, index) => {
        largest = Math.max(largest, distance(place, now[index]!));
      });
      before = now;
    }
    return largest;
  }

  test('one of them takes the trunk along and throws it nowhere, whichever way it goes, out and then aside', () => {
    fc.assert(
      fc.property(standpoint, direction, direction, (place, out, aside) => {
        const right = (metres: number) =>
          addScaled(addScaled(shoulder.right, out, 0.5 + Math.min(metres, 0.6)), aside, Math.max(0, metres - 0.6));
        expect(largestStep(place, (metres) => ({ left: hip.left, right: right(metres) }), 800)).toBeLessThan(0.006);
      }),
      { seed, numRuns: cases(20) },
    );
  });

  test('both of them, each another way, neither', () => {
    fc.assert(
      fc.property(standpoint, direction, direction, (place, left, right) => {
        const hands = (metres: number) => ({
          left: addScaled(shoulder.left, left, 0.5 + metres),
          right: addScaled(shoulder.right, right, 0.5 + metres),
        });
        expect(largestStep(place, hands, 600)).toBeLessThan(0.006);
      }),
      { seed, numRuns: cases(20) },
    );
  });
});

describe('hips under a chest that is too low for them to hang', () => {
  test('do not leap to its other side when they are estimated a little over there', () => {
    const below = fc.record({ angle: evenly(-3, 3), metres: evenly(0.005, 0.03), yaw: evenly(-3, 3) });
    fc.assert(
      fc.property(below, ({ angle, metres, yaw }) => {
        const elsewhere = { position: vec3(1, 0, -2), orientation: fromAxisAngle(up, yaw) };
        const upright = createEstimator('ik', calibration);
        const frame = transformFrame(elsewhere, standing(calibration, hip.left, hip.right));
        const joints = forwardKinematics(skeleton, poseOf(upright, frame).body!);
        // The whole person is 1.05 m lower: the chest is where hips should be.
        const lowered = (place: Vec3): Vec3 => addScaled(place, up, -1.05);
        const seated = completedFrame(
          {
            head: { ...frame.head, position: lowered(frame.head.position) },
            leftHand: { ...frame.leftHand!, position: lowered(frame.leftHand!.position) },
            rightHand: { ...frame.rightHand!, position: lowered(frame.rightHand!.position) },
          },
          calibration,
        );
        const estimated = Object.fromEntries(
          estimatedJoints.map((joint) => [joint, lowered(joints[joint].position)]),
        ) as Record<(typeof estimatedJoints)[number], Vec3>;
        const aside = vec3(Math.sin(angle), 0, Math.cos(angle));
        const fitBody = fitted(calibration);
        const hips: Vec3[] = [];
        for (let i = 0; i < 90; i++) {
          const under = addScaled(add(estimated.chest, vec3(0, -0.1, 0)), aside, i < 30 ? metres : -metres);
          const drawn = fitBody(seated, { ...estimated, hips: under }, i ? 1 / 60 : 0);
          hips.push(copyVec3(drawn.hips.position));
        }
        expect(distance(hips[29]!, hips[89]!)).toBeGreaterThan(0.3);
        expect(Math.max(...hips.slice(1).map((place, i) => distance(place, hips[i]!)))).toBeLessThan(0.03);
        expect(Math.min(...hips.map(({ y }) => y))).toBeGreaterThan(0.08);
      }),
      { seed, numRuns: 40 },
    );
  });
});
