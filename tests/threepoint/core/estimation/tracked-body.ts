import type { Calibration, Mutable, PoseEstimator } from 'threepoint/core';
import { invertTransform, type MutablePose, makeTransform, type Pose, transformPose, vec3 } from 'threepoint/math';
import {
  type TrackerOffset,
  type TrackerOffsets,
  trackerNames,
} from '../../../../src/threepoint/core/body/tracker-offsets';
import { createIk } from '../../../../src/threepoint/core/estimation/estimators';
import { pinning } from '../../../../src/threepoint/core/estimation/pinning';
import type { BodyTrackers } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { fromEulerYxz } from '../euler-angles';

const offset = (x: number, y: number, z: number, pitch: number, yaw: number, roll: number): TrackerOffset => ({
  position: vec3(x, y, z),
  orientation: fromEulerYxz(vec3(pitch, yaw, roll)),
});

/** Trackers on the belt, the breastbone and the insteps, each mounted as it came. */
export const wornOffsets = {
  hips: offset(0.02, -0.06, 0.13, 0.4, 2.8, -0.2),
  chest: offset(-0.03, 0.05, 0.11, -0.3, 0.5, 1.4),
  leftFoot: offset(0.01, 0.04, 0.08, 1.1, -0.4, 0.1),
  rightFoot: offset(-0.02, 0.03, 0.09, 0.9, 0.3, -0.3),
} as const satisfies TrackerOffsets;

export const withOffsets = (calibration: Calibration): Calibration => ({ ...calibration, trackerOffsets: wornOffsets });

/** Creates IK for a person who wears trackers with `wornOffsets`. */
export const createPinned = (calibration: Calibration): PoseEstimator =>
  createIk(withOffsets(calibration), { pinning });

export type TrueJoints = { readonly [Name in keyof typeof wornOffsets]?: Pose<'floor'> };

/** Returns the poses that trackers worn with `wornOffsets` report for these joints. */
export function trackersOn(joints: TrueJoints): BodyTrackers {
  const trackers: Mutable<BodyTrackers> = {};
  for (const name of trackerNames) {
    const joint = joints[name];
    if (!joint) continue;
    const jointFromTracker = invertTransform<'tracker', 'joint'>(wornOffsets[name], makeTransform());
    const pose: MutablePose<'floor'> = transformPose<'floor', 'joint'>(joint, jointFromTracker as Pose<'joint'>);
    trackers[name] = { ...pose, tracking: 'tracked' };
  }
  return trackers;
}
