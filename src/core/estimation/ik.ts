import type { Calibration } from '../body/calibration';
import { chestSpaceBody } from '../body/skeleton';
import { transformPose } from '../math/pose';
import type { ContinuedFrame } from '../tracking/hand-continuity';
import { floorFromHeading, headingFromFloor } from '../tracking/heading';
import { createBodyEstimator } from './body-estimator';
import { transformJoints } from './joint-positions';
import type { PoseEstimator } from './pose-estimator';
import { solveIk, type ThreePoints } from './solve-ik';

/** Head and hands in the heading frame of that head. */
export function pointsInHeading({ head, leftHand, rightHand }: ContinuedFrame): ThreePoints {
  const fromFloor = headingFromFloor(head);
  return {
    head: transformPose(fromFloor, head),
    leftHand: transformPose(fromFloor, leftHand),
    rightHand: transformPose(fromFloor, rightHand),
  };
}

/** Inverse kinematics with the same calibration as the networks: the competitor they are measured against. */
export function createIk(calibration: Calibration): PoseEstimator {
  let body = chestSpaceBody(calibration);
  return createBodyEstimator('ik', calibration, {
    calibrate(next) {
      body = chestSpaceBody(next);
    },
    reset: () => undefined,
    prepare: () => Promise.resolve(),
    joints: (frame) => transformJoints(floorFromHeading(frame.head), solveIk(pointsInHeading(frame), body)),
    rawJoints: () => null,
    fault: () => null,
  });
}
