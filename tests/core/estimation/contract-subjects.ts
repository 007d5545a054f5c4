import fc from 'fast-check';
import { test } from 'vitest';
import type { AvatarPose } from '../../../src/core/body/avatar-pose';
import type { Calibration } from '../../../src/core/body/calibration';
import { forwardKinematics } from '../../../src/core/body/forward-kinematics';
import { jointNames } from '../../../src/core/body/joints';
import { skeletonFromCalibration } from '../../../src/core/body/skeleton';
import { estimatorNames, type PoseEstimator } from '../../../src/core/estimation/pose-estimator';
import { distance } from '../../../src/core/math/vec3';
import type { TrackingFrame } from '../../../src/core/tracking/tracking-frame';
import { evenly, standpoint } from '../arbitraries';
import { type Joints, showAll } from './drawn';
import { movingPerson } from './moving-person';

export const rate = 1 / 60;

export const calibrationOf = fc
  .tuple(evenly(1, 2.1), evenly(0.86, 1.02))
  .map(([eyeHeight, ratio]): Calibration => ({ eyeHeight, armSpan: eyeHeight * ratio }));

/** A person of any size, standing anywhere, turned anyhow, in the middle of a movement. */
export const person = fc
  .record({ motion: fc.integer(), calibration: calibrationOf, standpoint, start: evenly(0, 100) })
  .map((one) => ({ ...one, at: movingPerson(one.motion, one.calibration, one.standpoint) }));

export const jointsOf = (pose: AvatarPose, calibration: Calibration): Joints => {
  if (pose.body === null) throw new Error('this estimator shows no body');
  return forwardKinematics(skeletonFromCalibration(calibration), pose.body);
};

/** The second frame of a motion: the first in which a network's answer is drawn. */
export const showSecond = (
  estimator: PoseEstimator,
  at: (time: number) => TrackingFrame,
  time: number,
): Promise<AvatarPose> => showAll(estimator, [at(time - rate), at(time)]);

export const times = (start: number, count: number, step = rate): number[] =>
  Array.from({ length: count }, (_, i) => start + i * step);

export const apart = (a: Joints, b: Joints): number =>
  Math.max(...jointNames.map((joint) => distance(a[joint].position, b[joint].position)));

/** A fact about some estimators; for the others there is no test, rather than one that is skipped. */
export const factIf = (holds: boolean): ((fact: string, check: () => Promise<void>) => void) =>
  holds ? test : () => undefined;

/** Every estimator, those with a network on the page's runtime; and the learned one without a runtime. */
export const subjects = [
  ...estimatorNames.map((name) => ({ label: name as string, name, plain: false })),
  { label: 'learned, without a runtime', name: 'learned' as const, plain: true },
];
