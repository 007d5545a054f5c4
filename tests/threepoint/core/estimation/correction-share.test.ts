import fc from 'fast-check';
import { createEstimator, estimatedJoints, forwardKinematics, skeletonFromCalibration } from 'threepoint/core';
import { distance, type Pose, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { correctionShare } from '../../../../src/threepoint/core/estimation/networks/correction-share';
import type { PoseEstimator } from '../../../../src/threepoint/core/estimation/pose-estimator';
import { createWithNetwork } from '../../../../src/threepoint/core/estimation/with-network';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { evenly, seed } from '../arbitraries';
import { fromEulerYxz } from '../euler-angles';
import { poseOf } from './drawn';
import { quat, readGolden } from './golden';
import { tracked, wristOrientation } from './moving-person';
import { calibration, degrees } from './posed-body';
import { openPlainModel } from './shipped-models';

const { eyeHeight } = calibration;

/** A head at a height [eye heights], pitched back and rolled by these angles [rad]. */
const headAt = (height: number, pitch: number, roll = 0): Pose<'heading'> => ({
  position: vec3(0, height * eyeHeight, 0),
  orientation: fromEulerYxz(vec3(pitch, 0, roll)),
});

const shareAt = (height: number, pitch: number, roll = 0): number =>
  correctionShare(headAt(height, pitch, roll), eyeHeight);

describe('the share of the network’s correction', () => {
  test('is whole for heads that tilt by less than 75° at any height', () => {
    const angle = evenly(-59, 59);
    fc.assert(
      fc.property(evenly(0, 1.5), angle, angle, (height, pitch, roll) => {
        expect(shareAt(height, pitch * degrees, roll * degrees)).toBe(1);
      }),
      { seed },
    );
  });

  test('is whole for people who lie on back, front or side', () => {
    fc.assert(
      fc.property(evenly(0.03, 0.15), evenly(70, 110), (height, tilt) => {
        for (const side of [-1, 1]) {
          expect(shareAt(height, side * tilt * degrees)).toBe(1);
          expect(shareAt(height, 0, side * tilt * degrees)).toBe(1);
        }
      }),
      { seed },
    );
  });

  test('is zero in handstands and flips', () => {
    fc.assert(
      fc.property(evenly(0.5, 1.4), evenly(115, 245), (height, pitch) => {
        expect(shareAt(height, pitch * degrees)).toBe(0);
      }),
      { seed },
    );
  });

  test('changes by less than 7 % for each degree of a flip', () => {
    for (const height of [0.3, 0.6, 1.2]) {
      for (let pitch = 0; pitch < 360; pitch++) {
        const change = shareAt(height, pitch * degrees) - shareAt(height, (pitch + 1) * degrees);
        expect(Math.abs(change)).toBeLessThan(0.07);
      }
    }
  });
});

test('TypeScript agrees with Python about the share', () => {
  const rows = readGolden<{ height: number; orientation: readonly number[]; share: number }[]>('correction-share.json');
  for (const { height, orientation, share } of rows) {
    const head = { position: vec3(0, height * eyeHeight, 0), orientation: quat(orientation) };
    expect(correctionShare(head, eyeHeight)).toBeCloseTo(share, 6);
  }
});

describe('the learned body', () => {
  const skeleton = skeletonFromCalibration(calibration);
  /** The estimated joints of a pose held for a second. */
  function held(estimator: PoseEstimator, head: Pose<'heading'>, hands: number) {
    const orientation = wristOrientation(vec3(0, 0, -1), vec3(1, 0, 0));
    const hand = (x: number) => tracked(vec3(x, hands, -0.2), orientation);
    const frame: Omit<TrackingFrame, 'time'> = {
      head: tracked(head.position, head.orientation),
      leftHand: hand(-0.25),
      rightHand: hand(0.25),
    };
    let pose = poseOf(estimator, { ...frame, time: 0 });
    for (let i = 1; i <= 60; i++) pose = poseOf(estimator, { ...frame, time: i / 60 });
    const joints = forwardKinematics(skeleton, pose.body!);
    return estimatedJoints.map((joint) => joints[joint].position);
  }
  /** The longest distance [m] from a joint of the learned body to IK's. */
  function fromIk(head: Pose<'heading'>, hands: number): number {
    const learned = held(createWithNetwork('learned', calibration, openPlainModel()), head, hands);
    const ik = held(createEstimator('ik', calibration), head, hands);
    return Math.max(...learned.map((joint, index) => distance(joint, ik[index]!)));
  }

  test('is that of IK in a handstand, and another one upright', () => {
    expect(fromIk(headAt(0.6, -120 * degrees), 0.1)).toBeLessThan(1e-6);
    expect(fromIk(headAt(1, 0), 1)).toBeGreaterThan(0.01);
  });
});
