import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { JointName } from '../../../../src/threepoint/core/body/joints';
import { skeletonFromCalibration } from '../../../../src/threepoint/core/body/skeleton';
import { mapJoints } from '../../../../src/threepoint/core/estimation/joint-positions';
import { limitJoints, makeLimitJointsState } from '../../../../src/threepoint/core/estimation/limit-joints';
import { angleBetween, identity, rotate } from '../../../../src/threepoint/core/math/quat';
import {
  add,
  addScaled,
  copyVec3,
  distance,
  dot,
  length,
  subtract,
  type Vec3,
  vec3,
} from '../../../../src/threepoint/core/math/vec3';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { evenly, seed } from '../arbitraries';
import { fromEulerYxz } from '../euler-angles';
import { completedFrame, fitted, type Joints } from './drawn';
import { standing, tracked } from './moving-person';
import { ahead, at, bentBy, bodyOf, calibration, degrees, hip } from './posed-body';

describe('elbow and trunk', () => {
  test('no elbow stays in the trunk, wherever the hand is held but at the other flank', () => {
    const place = fc.record({ x: evenly(-0.35, 0.45), y: evenly(0.85, 1.5), z: evenly(-0.45, 0.1) });
    let handsOutside = 0;
    fc.assert(
      fc.property(place, (wrist) => {
        const joints = bodyOf(standing(calibration, hip.left, vec3(wrist.x, wrist.y, wrist.z)));
        const trunk = subtract(at(joints, 'neck'), at(joints, 'hips'));
        const elbow = subtract(at(joints, 'rightLowerArm'), at(joints, 'hips'));
        const share = Math.max(0, Math.min(1, dot(elbow, trunk) / dot(trunk, trunk)));
        const off = addScaled(elbow, trunk, -share);
        // The shoulder's own line turns the ellipse a little: its narrow half decides. A hand in the trunk has no free
        // elbow.
        const handOff = subtract(at(joints, 'rightHand'), at(joints, 'hips'));
        const handShare = Math.max(0, Math.min(1, dot(handOff, trunk) / dot(trunk, trunk)));
        const handAside = addScaled(handOff, trunk, -handShare);
        if (Math.hypot(handAside.x, handAside.z) <= 0.2) return;
        // A right hand at the left flank gets there only round the trunk, which IK does not draw.
        if (wrist.x < -0.15 && wrist.z > -0.05) return;
        handsOutside += 1;
        expect(length(off)).toBeGreaterThan(0.07);
      }),
      { seed, numRuns: 300 },
    );
    expect(handsOutside).toBeGreaterThan(100);
  });
});

describe('the trunk', () => {
  const looking = (angles: Vec3, position = vec3(0, 1.62, 0)): TrackingFrame => {
    const head = tracked(position, fromEulerYxz(angles));
    return { ...standing(calibration, hip.left, hip.right), head };
  };
  const facing = (joints: Joints, joint: JointName): Vec3 => rotate(joints[joint].orientation, vec3(0, 0, -1));

  test('a person who stands upright is upright: hips under the head, at their height', () => {
    const joints = bodyOf(standing(calibration, hip.left, hip.right));
    const hips = at(joints, 'hips');
    expect(Math.abs(hips.x)).toBeLessThan(0.02);
    expect(Math.abs(hips.z - at(joints, 'head').z)).toBeLessThan(0.15);
    expect(hips.y / calibration.eyeHeight).toBeGreaterThan(0.56);
    expect(hips.y / calibration.eyeHeight).toBeLessThan(0.66);
  });

  test('looking down does not push the chest away', () => {
    const level = bodyOf(looking(vec3(0, 0, 0)));
    // Eyes go forward and down about the top of the neck.
    const down = bodyOf(looking(vec3(-0.8, 0, 0), vec3(0, 1.54, -0.03)));
    expect(distance(at(level, 'chest'), at(down, 'chest'))).toBeLessThan(0.16);
    expect(facing(down, 'head').y).toBeLessThan(-0.6);
    expect(facing(down, 'hips').y).toBeGreaterThan(-0.4);
  });

  test('a glance to the side turns the head further than the hips', () => {
    const joints = bodyOf(looking(vec3(0, 0.9, 0)));
    const yawOf = (joint: JointName) => Math.atan2(-facing(joints, joint).x, -facing(joints, joint).z);
    expect(yawOf('head')).toBeCloseTo(0.9, 6);
    expect(yawOf('hips')).toBeLessThan(0.75);
    expect(yawOf('hips')).toBeGreaterThan(-0.1);
  });

  test('bowing takes the head forward of the hips', () => {
    const frame = looking(vec3(-0.7, 0, 0), vec3(0, 1.2, -0.4));
    const joints = bodyOf({ ...frame, leftHand: null, rightHand: null });
    expect(at(joints, 'hips').z - at(joints, 'head').z).toBeGreaterThan(0.1);
    expect(at(joints, 'hips').y).toBeLessThan(1);
  });

  test('an estimate that turns about under a head on its side turns no person about', () => {
    const upright = bodyOf(standing(calibration, ahead.left, ahead.right));
    const joints = mapJoints((joint) => at(upright, joint));
    const bowed = { ...joints, hips: add(joints.hips, vec3(0, 0, 0.3)), chest: add(joints.chest, vec3(0, 0, 0.15)) };
    const bent = { ...joints, hips: add(joints.hips, vec3(0, 0, -0.3)), chest: add(joints.chest, vec3(0, 0, -0.15)) };
    const longestStep = (roll: number): number => {
      const head = tracked(vec3(0, 1.62, 0), fromEulerYxz(vec3(0, 0, roll)));
      const completed = completedFrame({ ...standing(calibration, ahead.left, ahead.right), head }, calibration);
      const limited = makeLimitJointsState();
      const fitBody = fitted(calibration);
      const hips = [bowed, bowed, bent, bent, bent].map((estimated, i) => {
        const seconds = i ? 1 / 60 : 0;
        return copyVec3(at(fitBody(completed, limitJoints(limited, estimated, completed, seconds), seconds), 'hips'));
      });
      return Math.max(...hips.slice(1).map((place, i) => distance(place, hips[i]!)));
    };
    expect(longestStep(-Math.PI / 2)).toBeLessThan(0.02);
  });

  test('crouching lowers the hips, which stay above the floor even with the head on it', () => {
    let aboveTheFloor = 0;
    fc.assert(
      fc.property(evenly(-0.2, 1.62), evenly(-1.5, 1), (height, pitch) => {
        const joints = bodyOf(looking(vec3(pitch, 0, 0), vec3(0, height, 0)));
        // A head under the floor is a floor at the wrong height: then the hips hang where the spine lets them.
        if (height <= 0.3) return;
        aboveTheFloor += 1;
        expect(at(joints, 'hips').y).toBeGreaterThan(0.05);
      }),
      { seed },
    );
    expect(aboveTheFloor).toBeGreaterThan(30);
  });

  test('the head keeps its pose upside down', () => {
    const joints = bodyOf(looking(vec3(Math.PI, 0, 0)));
    const eyes = add(
      at(joints, 'head'),
      rotate(joints.head.orientation, skeletonFromCalibration(calibration).eyesInHead),
    );
    expect(distance(eyes, vec3(0, 1.62, 0))).toBeLessThan(1e-9);
  });

  test('reaching with one hand brings that shoulder forward and turns the chest', () => {
    const joints = bodyOf(standing(calibration, hip.left, vec3(0.15, 1.3, -0.62)));
    expect(at(joints, 'rightUpperArm').z).toBeLessThan(at(joints, 'leftUpperArm').z - 0.02);
  });

  test('both hands pulled apart beyond the arms turn the chest, and finally lag by the rest', () => {
    const joints = bodyOf(standing(calibration, vec3(-0.2, 1.35, 1.2), vec3(0.2, 1.35, -1.2)));
    const line = subtract(at(joints, 'rightUpperArm'), at(joints, 'leftUpperArm'));
    expect(line.z).toBeLessThan(-0.1);
    expect(bentBy(joints, 'left')).toBeLessThan(2 * degrees);
    const missing = distance(at(joints, 'rightHand'), vec3(0.2, 1.35, -1.2));
    expect(missing).toBeGreaterThan(0.1);
    expect(missing).toBeLessThan(0.9);
  });

  test('the body with arms out is near its T-pose: no rotation but the elbows’ turn', () => {
    const joints = bodyOf(standing(calibration, vec3(-0.76, 1.42, 0.08), vec3(0.76, 1.42, 0.08)));
    for (const joint of ['hips', 'spine', 'chest', 'upperChest', 'leftShoulder', 'rightShoulder'] as const) {
      expect(angleBetween(joints[joint].orientation, identity)).toBeLessThan(30 * degrees);
    }
    expect(rotate(joints.leftUpperArm.orientation, vec3(-1, 0, 0)).x).toBeLessThan(-0.9);
    expect(rotate(joints.rightUpperArm.orientation, vec3(1, 0, 0)).x).toBeGreaterThan(0.9);
  });
});
