import fc from 'fast-check';
import { createEstimator, forwardKinematics, skeletonFromCalibration } from 'threepoint/core';
import {
  add,
  addScaled,
  copyVec3,
  distance,
  fromAxisAngle,
  lerp,
  normalise,
  rotate,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { armBones } from '../../../../src/threepoint/core/estimation/arms/fit-arms';
import type { CompletedFrame } from '../../../../src/threepoint/core/estimation/complete-hands';
import { type JointPositions, mapJoints } from '../../../../src/threepoint/core/estimation/joint-positions';
import { evenly, seed, vector } from '../arbitraries';
import { completedFrame, fitted, poseOf } from './drawn';
import { standing, transformFrame } from './moving-person';

const calibration = { eyeHeight: 1.62, armSpan: 1.53 };
const skeleton = skeletonFromCalibration(calibration);
const hip = { left: vec3(-0.22, 0.85, -0.05), right: vec3(0.22, 0.85, -0.05) };

/** Fits 90 frames whose hips are estimated so far [m] aside of `under`, to one side and after 30 to the other. */
function hipsAcross(
  seen: CompletedFrame,
  estimated: JointPositions,
  under: Vec3,
  { angle, metres }: { readonly angle: number; readonly metres: number },
): readonly Vec3[] {
  const aside = vec3(Math.sin(angle), 0, Math.cos(angle));
  const fitBody = fitted(calibration);
  return Array.from({ length: 90 }, (_, i) => {
    const hips = addScaled(under, aside, i < 30 ? metres : -metres);
    return copyVec3(fitBody(seen, { ...estimated, hips }, i ? 1 / 60 : 0).hips.position);
  });
}

describe('hips under a chest that is too low for them to hang', () => {
  test('do not leap to its other side when they are estimated a little over there', () => {
    const below = fc.record({ angle: evenly(-3, 3), metres: evenly(0.005, 0.03), yaw: evenly(-3, 3) });
    fc.assert(
      fc.property(below, ({ yaw, ...aside }) => {
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
        const estimated = mapJoints((joint) => lowered(joints[joint].position));
        const hips = hipsAcross(seated, estimated, add(estimated.chest, vec3(0, -0.1, 0)), aside);
        expect(distance(hips[29]!, hips[89]!)).toBeGreaterThan(0.3);
        expect(Math.max(...hips.slice(1).map((place, i) => distance(place, hips[i]!)))).toBeLessThan(0.03);
        expect(Math.min(...hips.map(({ y }) => y))).toBeGreaterThan(0.08);
      }),
      { seed, numRuns: 40 },
    );
  });
});

describe('a shoulder that is estimated at the root of its clavicle', () => {
  test('moves no faster than three times its estimate', () => {
    const frame = standing(calibration, hip.left, hip.right);
    const joints = forwardKinematics(skeleton, poseOf(createEstimator('ik', calibration), frame).body!);
    const estimated = mapJoints((joint) => joints[joint].position);
    fc.assert(
      fc.property(vector(0.02), vector(0.02), (from, to) => {
        const fitBody = fitted(calibration);
        const shoulderAt = (share: number) => {
          const rightUpperArm = add(joints.rightShoulder.position, lerp(from, to, share));
          const drawn = fitBody(completedFrame(frame, calibration), { ...estimated, rightUpperArm }, 1);
          return copyVec3(drawn.rightUpperArm.position);
        };
        const places = Array.from({ length: 41 }, (_, i) => shoulderAt(i / 40));
        const longest = Math.max(...places.slice(1).map((place, i) => distance(place, places[i]!)));
        expect(longest).toBeLessThan((3 * distance(from, to)) / 40 + 1e-6);
      }),
      { seed, numRuns: 50 },
    );
  });
});

describe('hips that are estimated almost at the chest joint', () => {
  test('swing to its other side when they are estimated there, and do not leap', () => {
    const near = fc.record({ angle: evenly(-3, 3), metres: evenly(0.03, 0.06), yaw: evenly(-3, 3) });
    fc.assert(
      fc.property(near, ({ yaw, ...aside }) => {
        const elsewhere = { position: vec3(-1, 0, 2), orientation: fromAxisAngle(up, yaw) };
        const frame = transformFrame(elsewhere, standing(calibration, hip.left, hip.right));
        const body = forwardKinematics(skeleton, poseOf(createEstimator('ik', calibration), frame).body!);
        const estimated = mapJoints((joint) => copyVec3(body[joint].position));
        const seen = completedFrame(
          { head: frame.head, leftHand: frame.leftHand!, rightHand: frame.rightHand! },
          calibration,
        );
        const hips = hipsAcross(seen, estimated, estimated.chest, aside);
        expect(distance(hips[29]!, hips[89]!)).toBeGreaterThan(0.3);
        expect(Math.max(...hips.slice(1).map((place, i) => distance(place, hips[i]!)))).toBeLessThan(0.05);
      }),
      { seed, numRuns: 40 },
    );
  });
});

describe('an arm that is stretched out', () => {
  const frame = standing(calibration, hip.left, hip.right);
  const body = forwardKinematics(skeleton, poseOf(createEstimator('ik', calibration), frame).body!);
  const joints = mapJoints((joint) => body[joint].position);
  const shoulder = joints.rightUpperArm;
  const { upper, lower } = armBones(skeleton);
  const twoHands = { head: frame.head, leftHand: frame.leftHand!, rightHand: frame.rightHand! };
  const ahead = normalise(vec3(0.3, -0.2, -1));

  test('straightens softly: its elbow never leaps, and its hand is on the controller', () => {
    const fitBody = fitted(calibration);
    let before: { hand: Vec3; elbow: Vec3 } | null = null;
    let shoulderCame = 0;
    for (let reach = 0.9; reach < 1.08; reach += 0.003) {
      const hand = addScaled(shoulder, ahead, reach * (upper + lower));
      const tracked = completedFrame(
        { ...twoHands, rightHand: { ...twoHands.rightHand, position: hand } },
        calibration,
      );
      const { rightHand, rightLowerArm, rightUpperArm } = fitBody(tracked, joints, before ? 1 / 60 : 0);
      const elbow = copyVec3(rightLowerArm.position);
      expect(distance(rightHand.position, hand)).toBeLessThan(1e-6);
      if (before) expect(distance(elbow, before.elbow)).toBeLessThan(2.2 * distance(hand, before.hand));
      shoulderCame = distance(rightUpperArm.position, shoulder);
      before = { hand, elbow };
    }
    expect(shoulderCame).toBeGreaterThan(0.03);
  });

  test('goes on after its hand beyond anatomy without a snap of the other shoulder', () => {
    const upwards = fc.record({ x: evenly(-1, 1), y: evenly(0.5, 1), z: evenly(-1, 1) });
    const outwards = fc.record({ x: evenly(0.6, 1), y: evenly(0, 0.6), z: evenly(-0.8, 0) });
    fc.assert(
      fc.property(outwards, upwards, (direction, offset) => {
        const fitBody = fitted(calibration);
        // The other shoulder is estimated where its clavicle does not reach.
        const leftUpperArm = addScaled(joints.leftUpperArm, normalise(offset), 0.15);
        const step = 0.001;
        let before: Vec3 | null = null;
        for (let far = 0.98 * (upper + lower); far < 1.15 * (upper + lower); far += step) {
          const hand = addScaled(shoulder, normalise(direction), far);
          const tracked = completedFrame(
            { ...twoHands, rightHand: { ...twoHands.rightHand, position: hand } },
            calibration,
          );
          const drawn = fitBody(tracked, { ...joints, leftUpperArm }, before ? 1 / 60 : 0);
          const other = copyVec3(drawn.leftUpperArm.position);
          if (before) expect(distance(other, before)).toBeLessThan(20 * step);
          before = other;
        }
      }),
      { seed, numRuns: 30 },
    );
  });

  test('leans a trunk of raised shoulders after its hand without a leap', () => {
    const aside = fc
      .record({ x: evenly(0, 1), y: evenly(-1, 1), z: evenly(-1, 1) })
      .map((way) => normalise(way, ahead));
    const posture = fc.record({ raised: evenly(0.3, 0.9), turned: evenly(-0.5, 0.5), from: aside, to: aside });
    const middle = lerp(joints.leftUpperArm, joints.rightUpperArm, 0.5);
    const half = distance(joints.leftUpperArm, joints.rightUpperArm) / 2;
    fc.assert(
      fc.property(posture, ({ raised, turned, from, to }) => {
        const line = rotate(fromAxisAngle(up, turned), vec3(Math.cos(raised), Math.sin(raised), 0));
        const estimated = {
          ...joints,
          leftUpperArm: addScaled(middle, line, -half),
          rightUpperArm: addScaled(middle, line, half),
        };
        const fitBody = fitted(calibration);
        let before: Record<'left' | 'right', Vec3> | null = null;
        for (let i = 0; i < 60; i++) {
          const away = normalise(lerp(from, to, i / 600), ahead);
          const position = addScaled(estimated.rightUpperArm, away, 0.5 + 0.004 * i);
          const tracked = completedFrame({ ...twoHands, rightHand: { ...twoHands.rightHand, position } }, calibration);
          const drawn = fitBody(tracked, estimated, i ? 1 / 60 : 0);
          const now = {
            left: copyVec3(drawn.leftUpperArm.position),
            right: copyVec3(drawn.rightUpperArm.position),
          };
          if (before) {
            expect(distance(now.left, before.left)).toBeLessThan(0.05);
            expect(distance(now.right, before.right)).toBeLessThan(0.05);
          }
          before = now;
        }
      }),
      // Shrinking a failure of a hundred trunks takes minutes.
      { seed, numRuns: 150, endOnFailure: true },
    );
  });

  test('stays as it is while a hand that is lost is held', () => {
    const fitBody = fitted(calibration);
    const hand = addScaled(shoulder, ahead, 1.02 * (upper + lower));
    const seen = completedFrame({ ...twoHands, rightHand: { ...twoHands.rightHand, position: hand } }, calibration);
    const elbows: Vec3[] = [];
    for (let i = 0; i < 24; i++) {
      const source = i < 18 ? ('tracked' as const) : ('held' as const);
      const confidence = i < 18 ? 1 : 1 - (i - 17) / 18;
      const drawn = fitBody({ ...seen, rightHand: { ...seen.rightHand, source, confidence } }, joints, i ? 1 / 60 : 0);
      elbows.push(copyVec3(drawn.rightLowerArm.position));
    }
    expect(distance(elbows[17]!, elbows[23]!)).toBeLessThan(0.001);
  });
});
