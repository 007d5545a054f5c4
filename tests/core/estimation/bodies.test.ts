import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { Calibration } from '../../../src/core/body/calibration';
import { forwardKinematics } from '../../../src/core/body/forward-kinematics';
import { estimatedJoints, type JointName } from '../../../src/core/body/joints';
import { chestSpaceBody, skeletonFromCalibration } from '../../../src/core/body/skeleton';
import { swivelAngle } from '../../../src/core/body/two-bone-ik';
import { completeHands, makeCompleteHandsState } from '../../../src/core/estimation/complete-hands';
import { createEstimator } from '../../../src/core/estimation/estimators';
import { filterJoints, makeFilterJointsState } from '../../../src/core/estimation/filter-joints';
import type { JointPositions } from '../../../src/core/estimation/joint-positions';
import type { TrackedPose } from '../../../src/core/math/pose';
import { angleBetween, fromAxisAngle, identity, multiply, rotate, twistAngle } from '../../../src/core/math/quat';
import { nextRandom } from '../../../src/core/math/random';
import type { Side } from '../../../src/core/math/side';
import {
  add,
  addScaled,
  copyVec3,
  cross,
  distance,
  dot,
  length,
  normalise,
  right,
  subtract,
  up,
  type Vec3,
  vec3,
} from '../../../src/core/math/vec3';
import type { TrackingFrame } from '../../../src/core/tracking/tracking-frame';
import { cases } from '../../nightly';
import { evenly, seed, standpoint } from '../arbitraries';
import { fromEulerYxz } from '../euler-angles';
import { completedFrame, fitted, type Joints, poseOf } from './drawn';
import { movingPerson, standing, wristOrientation } from './moving-person';

const calibration: Calibration = { eyeHeight: 1.62, armSpan: 1.53 };
const degrees = Math.PI / 180;

/** The body that IK gives a person who has held this pose for a while. */
function bodyOf(frame: TrackingFrame, body = calibration): Joints {
  const estimator = createEstimator('ik', body);
  let joints: Joints | null = null;
  for (let i = 0; i < 5; i++) {
    const pose = poseOf(estimator, { ...frame, time: frame.time + i / 60 });
    joints = forwardKinematics(skeletonFromCalibration(body), pose.body!);
  }
  return joints!;
}

const at = (joints: Joints, joint: JointName): Vec3 => joints[joint].position;

/** The angle [rad] at the elbow between the two bones. */
const bentBy = (joints: Joints, side: Side): number => {
  const upper = normalise(subtract(at(joints, `${side}LowerArm`), at(joints, `${side}UpperArm`)));
  const lower = normalise(subtract(at(joints, `${side}Hand`), at(joints, `${side}LowerArm`)));
  return Math.acos(Math.max(-1, Math.min(1, dot(upper, lower))));
};

const hip = { left: vec3(-0.22, 0.85, -0.05), right: vec3(0.22, 0.85, -0.05) };
const ahead = { left: vec3(-0.2, 1.25, -0.4), right: vec3(0.2, 1.25, -0.4) };

/** Elbow relative to the middle of the straight line from shoulder to wrist. */
const elbowAside = (joints: Joints, side: Side): Vec3 => {
  const shoulder = at(joints, `${side}UpperArm`);
  const hand = at(joints, `${side}Hand`);
  return subtract(
    at(joints, `${side}LowerArm`),
    vec3((shoulder.x + hand.x) / 2, (shoulder.y + hand.y) / 2, (shoulder.z + hand.z) / 2),
  );
};

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

  test('an elbow that was estimated inside the trunk comes out of it', () => {
    const inTrunk = fc.record({ x: evenly(-0.08, 0.08), y: evenly(-0.02, 0.15), z: evenly(-0.08, 0.06) });
    const before = fc.record({ x: evenly(-0.25, 0.3), y: evenly(0.95, 1.35), z: evenly(-0.4, -0.15) });
    let besideTheTrunk = 0;
    fc.assert(
      fc.property(before, inTrunk, (wrist, inside) => {
        const frame = standing(calibration, hip.left, vec3(wrist.x, wrist.y, wrist.z));
        const upright = bodyOf(frame);
        const chest = at(upright, 'chest');
        const joints = Object.fromEntries(
          estimatedJoints.map((joint) => [joint, at(upright, joint)]),
        ) as JointPositions;
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
    const joints = Object.fromEntries(estimatedJoints.map((joint) => [joint, at(upright, joint)])) as JointPositions;
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

  test('no wrist is wrung: the forearm takes its part of the hand’s turn', () => {
    for (const roll of [-80, -40, 0, 40, 80]) {
      const frame = standing(calibration, hip.left, ahead.right);
      const orientation = multiply(
        wristOrientation(normalise(vec3(0, -0.1, -1)), vec3(1, 0, 0)),
        fromAxisAngle(vec3(0, 0, 1), roll * degrees),
      );
      const pose = poseOf(createEstimator('ik', calibration), {
        ...frame,
        rightHand: { ...frame.rightHand, orientation },
      });
      const wrist = twistAngle(pose.body!.localRotations.rightHand, right);
      const forearm = twistAngle(pose.body!.localRotations.rightLowerArm, right);
      expect(Math.abs(wrist)).toBeLessThan(70 * degrees);
      expect(Math.abs(wrist - forearm)).toBeLessThan(1 * degrees);
    }
  });

  test('a hand turns as its controller does, palm down, palm up and thumb up', () => {
    for (const roll of [-80, 0, 80]) {
      const frame = standing(calibration, hip.left, ahead.right);
      const orientation = multiply(
        wristOrientation(normalise(vec3(0, -0.1, -1)), vec3(1, 0, 0)),
        fromAxisAngle(vec3(0, 0, 1), roll * degrees),
      );
      const joints = bodyOf({ ...frame, rightHand: { ...frame.rightHand, orientation } });
      // In T-pose the right hand's fingers point to +X: its wrist frame is turned by −90° about +Y.
      const shown = multiply(joints.rightHand.orientation, fromAxisAngle(up, -Math.PI / 2));
      expect(shown).toBeSameRotationAs(orientation, 0.01);
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

describe('a hand that is lost', () => {
  const skeleton = skeletonFromCalibration(calibration);
  /** A person who crouches or bows: the head at this height, so far ahead of where it was, looking down by so much [rad]. */
  const lowered = (time: number, height: number, ahead: number, down: number): TrackingFrame => ({
    ...standing(calibration, hip.left, vec3(0.2, height - 0.3, -ahead - 0.3)),
    time,
    head: { position: vec3(0, height, -ahead), orientation: fromEulerYxz(vec3(-down, 0, 0)), tracking: 'tracked' },
  });

  test('does not pull the trunk after it when a person crouches, bows or sits on the floor', () => {
    const posture = fc.record({ height: evenly(0.5, 1.6), ahead: evenly(0, 0.5), down: evenly(0, 1.4) });
    fc.assert(
      fc.property(posture, ({ height, ahead, down }) => {
        const estimator = createEstimator('ik', calibration);
        let [joints, before]: [Joints | null, Joints | null] = [null, null];
        for (let i = 0; i < 120; i++) {
          const frame = lowered(i / 60, height, ahead, down);
          const { body } = poseOf(estimator, i < 20 ? frame : { ...frame, rightHand: null });
          before = joints;
          joints = forwardKinematics(skeleton, body!);
          if (!before) continue;
          for (const joint of ['hips', 'chest', 'neck', 'leftUpperArm', 'rightUpperArm', 'leftLowerArm'] as const) {
            expect(distance(at(joints, joint), at(before, joint))).toBeLessThan(0.05);
          }
        }
        // It rests below its shoulder, as far as the floor lets it.
        expect(at(joints!, 'rightHand').y).toBeLessThan(at(joints!, 'rightUpperArm').y + 0.1);
      }),
      { seed, numRuns: cases(40) },
    );
  });

  test('comes and goes without a jump of any joint, in any motion of the person meanwhile', () => {
    fc.assert(
      fc.property(fc.integer(), standpoint, evenly(0.1, 2), evenly(0, 60), (motion, place, seconds, start) => {
        const person = movingPerson(motion, calibration, place);
        const [whole, lossy] = [createEstimator('ik', calibration), createEstimator('ik', calibration)];
        let before: { readonly whole: Joints; readonly lossy: Joints } | null = null;
        let furthest = 0;
        for (let i = 0; i < 240; i++) {
          const frame = person(start + i / 60);
          const lost = i >= 30 && i < 30 + seconds * 60;
          const now = {
            whole: forwardKinematics(skeleton, poseOf(whole, frame).body!),
            lossy: forwardKinematics(skeleton, poseOf(lossy, lost ? { ...frame, rightHand: null } : frame).body!),
          };
          for (const joint of before
            ? (['hips', 'chest', 'rightUpperArm', 'rightLowerArm', 'rightHand'] as const)
            : []) {
            const own = distance(at(now.whole, joint), at(before!.whole, joint));
            furthest = Math.max(furthest, distance(at(now.lossy, joint), at(before!.lossy, joint)) - own);
          }
          before = now;
        }
        expect(furthest).toBeLessThan(0.05);
      }),
      { seed, numRuns: cases(20) },
    );
  });

  const reachFromShoulder = fc.record({
    yaw: evenly(-1, 1.6),
    pitch: evenly(-1.2, 1),
    share: evenly(0.1, 1.02),
    seconds: evenly(0.12, 1.5),
  });

  test('comes back without a snap of its elbow wherever that is, all but out of reach or close to the shoulder', () => {
    fc.assert(
      fc.property(reachFromShoulder, ({ yaw, pitch, share, seconds }) => {
        const estimator = createEstimator('ik', calibration);
        const there = vec3(Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), -Math.cos(yaw) * Math.cos(pitch));
        const back = addScaled(
          at(bodyOf(standing(calibration, hip.left, hip.right)), 'rightUpperArm'),
          there,
          0.56 * share,
        );
        let before: Joints | null = null;
        for (let i = 0; i < 180; i++) {
          const lost = i >= 20 && i < 20 + seconds * 60;
          const frame = { ...standing(calibration, hip.left, i < 20 ? ahead.right : back), time: i / 60 };
          const { body } = poseOf(estimator, lost ? { ...frame, rightHand: null } : frame);
          const joints = forwardKinematics(skeleton, body!);
          for (const joint of before ? (['rightUpperArm', 'rightLowerArm', 'rightHand'] as const) : [])
            expect(distance(at(joints, joint), at(before!, joint))).toBeLessThan(0.05);
          before = joints;
          // However far it was, it is where it is seen within 0.9 s.
          if (i > 20 + seconds * 60 + 54) expect(distance(at(joints, 'rightHand'), back)).toBeLessThan(2e-3);
        }
      }),
      { seed, numRuns: cases(40) },
    );
  });

  test('is back for good once it is back: then a body that whirls about leaves it on its controller', () => {
    const whirl = fc.record({
      metres: evenly(0.05, 0.12),
      rate: evenly(8, 16),
      at: evenly(0.7, 1.5),
      turn: evenly(-3, 3),
    });
    fc.assert(
      fc.property(whirl, ({ metres, rate, at: whirlAt, turn }) => {
        const estimator = createEstimator('ik', calibration);
        for (let i = 0; i < 180; i++) {
          const back = (i - 26) / 60;
          // The hand draws circles all the while, so that its arm is never at rest.
          const circle = vec3(Math.sin((rate * i) / 60) * metres, Math.cos((rate * i) / 60) * metres, 0);
          const hand = add(vec3(0.18, 1.25, -0.3), circle);
          const frame = { ...standing(calibration, hip.left, hand), time: i / 60 };
          const yaw = turn * Math.min(Math.max((back - whirlAt) / 0.15, 0), 1);
          const head: TrackedPose = { ...frame.head, orientation: fromEulerYxz(vec3(0, yaw, 0)) };
          const lost = i >= 20 && back < 0;
          const { body } = poseOf(estimator, { ...frame, head, rightHand: lost ? null : frame.rightHand });
          if (back < 0.7) continue;
          const joints = forwardKinematics(skeleton, body!);
          expect(distance(at(joints, 'rightHand'), hand)).toBeLessThan(1e-4);
        }
      }),
      { seed, numRuns: 60 },
    );
  });

  test('is on its controller 0.9 s after it is seen again, however wildly its elbow and the trunk are estimated', () => {
    const upright = bodyOf(standing(calibration, hip.left, ahead.right));
    const place = fc.record({ x: evenly(-0.1, 0.35), y: evenly(1.1, 1.5), z: evenly(-0.35, -0.15) });
    const scatter = fc.tuple(fc.integer(), evenly(0.02, 0.3), place);
    fc.assert(
      fc.property(scatter, ([start, metres, hand]) => {
        const hands = makeCompleteHandsState();
        const body = chestSpaceBody(calibration);
        const fitBody = fitted(calibration);
        let random = { seed: start };
        const near = (position: Vec3): Vec3 => {
          const aside = [0, 0, 0].map(() => {
            const { value, state } = nextRandom(random);
            random = state;
            return metres * (2 * value - 1);
          });
          return add(position, vec3(aside[0]!, aside[1]!, aside[2]!));
        };
        for (let i = 0; i < 120; i++) {
          const seen = i < 20 || i >= 50;
          const frame = { ...standing(calibration, hip.left, hand as Vec3), time: i / 60 };
          const joints = Object.fromEntries(
            estimatedJoints.map((joint) => [joint, near(at(upright, joint))]),
          ) as JointPositions;
          const deltaSeconds = i ? 1 / 60 : 0;
          const tracked = seen ? frame : { ...frame, rightHand: null };
          const drawn = fitBody(completeHands(hands, frame.head, tracked, body, deltaSeconds), joints, deltaSeconds);
          if (i < 50 + 0.9 * 60) continue;
          expect(distance(at(drawn, 'rightHand'), hand as Vec3)).toBeLessThan(1e-4);
        }
      }),
      { seed, numRuns: 100 },
    );
  });

  test('a pause begins anew: nothing of the arm before it is left', () => {
    const person = movingPerson(7, calibration, { x: 1, z: -2, yaw: 2 });
    const [used, fresh] = [createEstimator('ik', calibration), createEstimator('ik', calibration)];
    for (let i = 0; i < 30; i++) poseOf(used, person(i / 60));
    const later = person(40);
    expect(poseOf(used, later)).toEqual(poseOf(fresh, later));
  });
});

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
        // The shoulder's own line turns the ellipse a little: its narrow half decides. A hand in the trunk has no free elbow.
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
    const head: TrackedPose = { position, orientation: fromEulerYxz(angles), tracking: 'tracked' };
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

  test('an estimate that turns about at once turns no person about at once, least of all under a head on its side', () => {
    const upright = bodyOf(standing(calibration, ahead.left, ahead.right));
    const joints = Object.fromEntries(estimatedJoints.map((joint) => [joint, at(upright, joint)])) as JointPositions;
    const bowed = { ...joints, hips: add(joints.hips, vec3(0, 0, 0.3)), chest: add(joints.chest, vec3(0, 0, 0.15)) };
    const bent = { ...joints, hips: add(joints.hips, vec3(0, 0, -0.3)), chest: add(joints.chest, vec3(0, 0, -0.15)) };
    const longestStep = (roll: number): number => {
      const head: TrackedPose = {
        position: vec3(0, 1.62, 0),
        orientation: fromEulerYxz(vec3(0, 0, roll)),
        tracking: 'tracked',
      };
      const completed = completedFrame({ ...standing(calibration, ahead.left, ahead.right), head }, calibration);
      const filter = makeFilterJointsState();
      const fitBody = fitted(calibration);
      const hips = [bowed, bowed, bent, bent, bent].map((estimated, i) => {
        const seconds = i ? 1 / 60 : 0;
        return copyVec3(at(fitBody(completed, filterJoints(filter, estimated, completed, seconds), seconds), 'hips'));
      });
      return Math.max(...hips.slice(1).map((place, i) => distance(place, hips[i]!)));
    };
    expect(longestStep(0)).toBeLessThan(0.05);
    expect(longestStep(-Math.PI / 2)).toBeLessThan(0.02);
  });

  test('crouching lowers the hips, and they stay above the floor even when the head is on it', () => {
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

  test('both hands pulled to opposite sides beyond the arms turn the chest, and at last stay behind by what is missing', () => {
    const joints = bodyOf(standing(calibration, vec3(-0.2, 1.35, 1.2), vec3(0.2, 1.35, -1.2)));
    const line = subtract(at(joints, 'rightUpperArm'), at(joints, 'leftUpperArm'));
    expect(line.z).toBeLessThan(-0.1);
    expect(bentBy(joints, 'left')).toBeLessThan(2 * degrees);
    const missing = distance(at(joints, 'rightHand'), vec3(0.2, 1.35, -1.2));
    expect(missing).toBeGreaterThan(0.1);
    expect(missing).toBeLessThan(0.9);
  });

  test('with the arms out the body is near its T-pose: no rotation, but for how far the elbows turn', () => {
    const joints = bodyOf(standing(calibration, vec3(-0.76, 1.42, 0.08), vec3(0.76, 1.42, 0.08)));
    for (const joint of ['hips', 'spine', 'chest', 'upperChest', 'leftShoulder', 'rightShoulder'] as const) {
      expect(angleBetween(joints[joint].orientation, identity)).toBeLessThan(30 * degrees);
    }
    expect(rotate(joints.leftUpperArm.orientation, vec3(-1, 0, 0)).x).toBeLessThan(-0.9);
    expect(rotate(joints.rightUpperArm.orientation, vec3(1, 0, 0)).x).toBeGreaterThan(0.9);
  });
});
