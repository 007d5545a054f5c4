import fc from 'fast-check';
import { createEstimator, forwardKinematics, skeletonFromCalibration } from 'threepoint/core';
import {
  add,
  addScaled,
  backward,
  cross,
  distance,
  fromAxisAngle,
  multiply,
  normalise,
  right,
  subtract,
  twistAngle,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { swivelAngle } from '../../../../bench/evaluate/measures';
import { mapJoints } from '../../../../src/threepoint/core/estimation/joint-positions';
import { evenly, seed } from '../arbitraries';
import { completedFrame, fitted, type Joints, poseOf } from './drawn';
import { standing, tracked, wristOrientation } from './moving-person';
import { ahead, at, bentBy, bodyOf, calibration, degrees, elbowAside, hip } from './posed-body';
import { openPlainModel } from './shipped-models';

describe('arms', () => {
  test('the elbow points backward when the hand rests at the hip', () => {
    const joints = bodyOf(standing(calibration, hip.left, hip.right));
    for (const side of ['left', 'right'] as const) {
      expect(elbowAside(joints, side).z).toBeGreaterThan(0.02);
      expect(at(joints, `${side}LowerArm`).y).toBeLessThan(at(joints, `${side}UpperArm`).y - 0.15);
    }
  });

  test('the elbow points down and outward when the hands are held ahead', () => {
    const joints = bodyOf(standing(calibration, ahead.left, ahead.right));
    expect(elbowAside(joints, 'left').y).toBeLessThan(-0.03);
    expect(elbowAside(joints, 'right').y).toBeLessThan(-0.03);
    expect(elbowAside(joints, 'right').x).toBeGreaterThan(0);
    expect(elbowAside(joints, 'left').x).toBeLessThan(0);
  });

  test('a stretched arm is straight', () => {
    const joints = bodyOf(standing(calibration, vec3(-0.2, 1.4, -1.2), vec3(0.2, 1.4, -1.2)));
    expect(bentBy(joints, 'left')).toBeLessThan(2 * degrees);
    expect(bentBy(joints, 'right')).toBeLessThan(2 * degrees);
  });

  test('a hand at the shoulder bends the elbow sharply', () => {
    const joints = bodyOf(standing(calibration, hip.left, vec3(0.2, 1.36, -0.12)));
    expect(bentBy(joints, 'right')).toBeGreaterThan(110 * degrees);
    expect(bentBy(joints, 'left')).toBeLessThan(60 * degrees);
  });

  test('raising the hand raises the shoulder', () => {
    const low = bodyOf(standing(calibration, hip.left, hip.right));
    const high = bodyOf(standing(calibration, hip.left, vec3(0.25, 1.95, -0.1)));
    const lift = (joints: Joints) => at(joints, 'rightUpperArm').y - at(joints, 'rightShoulder').y;
    expect(lift(high)).toBeGreaterThan(lift(low) + 0.01);
  });

  test.each([
    ['ik', null],
    ['learned', openPlainModel()],
  ] as const)('pronation moves the elbow outward and supination inward, alike on both sides: %s', (name, network) => {
    for (const { x, y, z } of [vec3(0.2, 1.15, -0.38), vec3(0.5, 1.2, -0.2), vec3(0.2, 1.45, -0.4)]) {
      const [farSupinated, supinated, thumbUp, pronated, farPronated] = [-120, -80, 0, 80, 120].map((roll) => {
        const hand = (sigma: number) => {
          const orientation = wristOrientation(vec3(-0.15 * sigma, 0.1, -1), vec3(sigma, 0, 0));
          const turned = multiply(orientation, fromAxisAngle(backward, sigma * roll * degrees));
          return tracked(vec3(sigma * x, y, z), turned);
        };
        const estimator = createEstimator(name, calibration, network);
        const frame = { ...standing(calibration, hip.left, hip.right), leftHand: hand(-1), rightHand: hand(1) };
        const poses = Array.from({ length: 120 }, (_, i) => poseOf(estimator, { ...frame, time: i / 60 }));
        const joints = forwardKinematics(skeletonFromCalibration(calibration), poses.at(-1)!.body!);
        expect(at(joints, 'leftLowerArm').x).toBeCloseTo(-at(joints, 'rightLowerArm').x, 6);
        return at(joints, 'rightLowerArm').x;
      });
      expect(pronated!).toBeGreaterThan(thumbUp! + 0.01);
      expect(supinated!).toBeLessThan(thumbUp! - 0.01);
      expect(farPronated!).toBeGreaterThan(thumbUp! + 0.03);
      expect(farSupinated!).toBeLessThan(thumbUp! + 0.005);
    }
  });

  test('an elbow that was estimated inside the trunk comes out of it', () => {
    const inTrunk = fc.record({ x: evenly(-0.08, 0.08), y: evenly(-0.02, 0.15), z: evenly(-0.08, 0.06) });
    const before = fc.record({ x: evenly(-0.25, 0.3), y: evenly(0.95, 1.35), z: evenly(-0.4, -0.15) });
    let besideTheTrunk = 0;
    fc.assert(
      fc.property(before, inTrunk, (wrist, inside) => {
        const frame = standing(calibration, hip.left, vec3(wrist.x, wrist.y, wrist.z));
        const upright = bodyOf(frame);
        const chest = at(upright, 'chest');
        const joints = mapJoints((joint) => at(upright, joint));
        const estimate = { ...joints, rightLowerArm: add(chest, inside as Vec3) };
        const solved = fitted(calibration)(completedFrame(frame, calibration), estimate, 0);
        const elbow = subtract(at(solved, 'rightLowerArm'), at(solved, 'chest'));
        const belowNeck = at(solved, 'rightLowerArm').y < at(solved, 'neck').y - 0.02;
        const aboveHips = at(solved, 'rightLowerArm').y > at(solved, 'hips').y;
        if (!belowNeck || !aboveHips) return;
        besideTheTrunk += 1;
        expect(Math.hypot(elbow.x / 0.12, elbow.z / 0.08)).toBeGreaterThan(1);
      }),
      { seed, numRuns: 300 },
    );
    expect(besideTheTrunk).toBeGreaterThan(100);
  });

  describe('an elbow from frame to frame', () => {
    const frame = standing(calibration, hip.left, ahead.right);
    const completed = completedFrame(frame, calibration);
    const upright = bodyOf(frame);
    const joints = mapJoints((joint) => at(upright, joint));
    const shoulder = joints.rightUpperArm;
    const wrist = ahead.right;
    const middle = vec3((shoulder.x + wrist.x) / 2, (shoulder.y + wrist.y) / 2, (shoulder.z + wrist.z) / 2);
    const across = normalise(subtract(at(upright, 'rightLowerArm'), middle));

    /** The angle [rad] by which elbows turn about the arm's line, from one estimate to the next, `seconds` apart. */
    const turned = (estimates: readonly Vec3[], seconds: number): number[] => {
      const fitBody = fitted(calibration);
      const elbows = estimates.map((rightLowerArm, i) =>
        at(fitBody(completed, { ...joints, rightLowerArm }, i ? seconds : 0), 'rightLowerArm'),
      );
      return elbows.slice(1).map((elbow, i) => Math.abs(swivelAngle(shoulder, wrist, elbows[i]!, elbow)));
    };

    test('does not flip when its estimate jumps to the other side', () => {
      const [down, raised] = [addScaled(middle, across, 0.2), addScaled(middle, across, -0.2)];
      for (const rate of [60, 120]) {
        const angles = turned([down, raised, raised], 1 / rate);
        for (const angle of angles) {
          expect(angle).toBeGreaterThan(0.05);
          expect(angle).toBeLessThan(15 / rate);
        }
      }
    });

    test('gets to the other side all the same, when the estimate stays there', () => {
      const angles = turned(
        [addScaled(middle, across, 0.2), ...Array(30).fill(addScaled(middle, across, -0.2))],
        1 / 60,
      );
      expect(angles.reduce((sum, angle) => sum + angle, 0)).toBeGreaterThan(3);
      expect(angles.at(-1)).toBeLessThan(1e-6);
    });

    test('heeds little of an estimate that is almost on the arm’s line', () => {
      const beside = normalise(cross(subtract(wrist, shoulder), across));
      const unsure = [1, -1, 1, -1].map((way) => addScaled(middle, beside, 0.004 * way));
      for (const angle of turned([addScaled(middle, across, 0.2), ...unsure], 1 / 60)) expect(angle).toBeLessThan(0.06);
    });
  });

  /** A person whose right hand reaches ahead, palm inwards but for this roll [degrees]. */
  function reaching(roll: number) {
    const frame = standing(calibration, hip.left, ahead.right);
    const orientation = multiply(
      wristOrientation(normalise(vec3(0, -0.1, -1)), vec3(1, 0, 0)),
      fromAxisAngle(vec3(0, 0, 1), roll * degrees),
    );
    return { ...frame, rightHand: { ...frame.rightHand, orientation } };
  }

  test('no wrist is wrung: the forearm takes its part of the hand’s turn', () => {
    for (const roll of [-80, -40, 0, 40, 80]) {
      const pose = poseOf(createEstimator('ik', calibration), reaching(roll));
      const wrist = twistAngle(pose.body!.localRotations.rightHand, right);
      const forearm = twistAngle(pose.body!.localRotations.rightLowerArm, right);
      expect(Math.abs(wrist)).toBeLessThan(70 * degrees);
      expect(Math.abs(wrist - forearm)).toBeLessThan(1 * degrees);
    }
  });

  test('a hand turns as its controller does, palm down, palm up and thumb up', () => {
    for (const roll of [-80, 0, 80]) {
      const frame = reaching(roll);
      const joints = bodyOf(frame);
      // In T-pose the right hand's fingers point to +X: its wrist frame is turned by −90° about +Y.
      const shown = multiply(joints.rightHand.orientation, fromAxisAngle(up, -Math.PI / 2));
      expect(shown).toBeSameRotationAs(frame.rightHand.orientation, 0.01);
    }
  });

  test('an elbow does not flip while the hand sweeps through the straight arm and back', () => {
    const estimator = createEstimator('ik', calibration);
    let before: Joints | null = null;
    for (let i = 0; i <= 240; i++) {
      const z = -0.35 - 0.4 * Math.sin((i / 240) * Math.PI);
      const frame = { ...standing(calibration, hip.left, vec3(0.2, 1.35, z)), time: i / 60 };
      const joints = forwardKinematics(skeletonFromCalibration(calibration), poseOf(estimator, frame).body!);
      if (before) expect(distance(at(joints, 'rightLowerArm'), at(before, 'rightLowerArm'))).toBeLessThan(0.03);
      before = joints;
    }
  });
});
