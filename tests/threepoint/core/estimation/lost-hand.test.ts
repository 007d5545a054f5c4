import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { forwardKinematics } from '../../../../src/threepoint/core/body/forward-kinematics';
import { chestSpaceBody, skeletonFromCalibration } from '../../../../src/threepoint/core/body/skeleton';
import { armBones } from '../../../../src/threepoint/core/estimation/arms/fit-arms';
import { completeHands, makeCompleteHandsState } from '../../../../src/threepoint/core/estimation/complete-hands';
import { createEstimator } from '../../../../src/threepoint/core/estimation/estimators';
import { mapJoints } from '../../../../src/threepoint/core/estimation/joint-positions';
import type { TrackedPose } from '../../../../src/threepoint/core/math/pose';
import { nextRandom } from '../../../../src/threepoint/core/math/random';
import { add, addScaled, distance, type Vec3, vec3 } from '../../../../src/threepoint/core/math/vec3';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { cases } from '../../../nightly';
import { evenly, seed, standpoint } from '../arbitraries';
import { fromEulerYxz } from '../euler-angles';
import { fitted, type Joints, poseOf } from './drawn';
import { movingPerson, standing } from './moving-person';
import { ahead, at, bodyOf, calibration, hip } from './posed-body';

describe('a hand that is lost', () => {
  const skeleton = skeletonFromCalibration(calibration);
  /**
   * A person who crouches or bows: the head at this height, so far ahead of where it was, looking down by so much
   * [rad].
   */
  const lowered = (time: number, height: number, ahead: number, down: number): TrackingFrame => ({
    ...standing(calibration, hip.left, vec3(0.2, height - 0.3, -ahead - 0.3)),
    time,
    head: { position: vec3(0, height, -ahead), orientation: fromEulerYxz(vec3(-down, 0, 0)), tracking: 'tracked' },
  });

  test('does not pull the trunk when a person crouches, bows or sits on the floor', () => {
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
          if (i < 20) continue;
          for (const joint of ['hips', 'chest', 'neck', 'leftUpperArm', 'rightUpperArm', 'leftLowerArm'] as const) {
            // Near full stretch the other elbow goes further than the trunk that it hangs from.
            const most = joint === 'leftLowerArm' ? 0.06 : 0.05;
            expect(distance(at(joints, joint), at(before!, joint))).toBeLessThan(most);
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
    share: evenly(0.2, 1.02),
    seconds: evenly(0.12, 1.5),
  });

  test('comes back without a snap of its elbow, even barely in reach or at the shoulder', { tags: ['full'] }, () => {
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

  test('is back for good once it is back: a whirling body leaves it on its controller', { tags: ['full'] }, () => {
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
      { seed, numRuns: cases(30) },
    );
  });

  test('is on its controller 0.9 s after its return, however wildly elbow and trunk are estimated', {
    tags: ['full'],
  }, () => {
    const upright = bodyOf(standing(calibration, hip.left, ahead.right));
    const { upper, lower } = armBones(skeleton);
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
          const joints = mapJoints((joint) => near(at(upright, joint)));
          const deltaSeconds = i ? 1 / 60 : 0;
          const tracked = seen ? frame : { ...frame, rightHand: null };
          const drawn = fitBody(completeHands(hands, frame.head, tracked, body, deltaSeconds), joints, deltaSeconds);
          if (i < 50 + 0.9 * 60) continue;
          // A shoulder may be estimated closer than an arm folds, or further away than it is long.
          const far = distance(at(drawn, 'rightUpperArm'), hand);
          const outOfReach = Math.max(0, Math.abs(upper - lower) - far, far - (upper + lower));
          expect(distance(at(drawn, 'rightHand'), hand)).toBeLessThan(outOfReach + 1e-4);
        }
      }),
      { seed, numRuns: cases(50) },
    );
  });

  test('a pause resets: nothing of the arm before it is left', () => {
    const person = movingPerson(7, calibration, { x: 1, z: -2, yaw: 2 });
    const [used, fresh] = [createEstimator('ik', calibration), createEstimator('ik', calibration)];
    for (let i = 0; i < 30; i++) poseOf(used, person(i / 60));
    const later = person(40);
    expect(poseOf(used, later)).toEqual(poseOf(fresh, later));
  });
});
