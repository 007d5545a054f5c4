import fc from 'fast-check';
import { afterAll, beforeAll, test } from 'vitest';
import type { AvatarPose } from '../../../../src/threepoint/core/body/avatar-pose';
import type { Calibration } from '../../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../../src/threepoint/core/body/forward-kinematics';
import { jointNames } from '../../../../src/threepoint/core/body/joints';
import { skeletonFromCalibration } from '../../../../src/threepoint/core/body/skeleton';
import { createEstimator, needsRegressor, networkOf } from '../../../../src/threepoint/core/estimation/estimators';
import type { PoseRegressor } from '../../../../src/threepoint/core/estimation/networks/pose-regressor';
import type { PipelineOptions } from '../../../../src/threepoint/core/estimation/pipeline';
import { estimatorNames, type PoseEstimator } from '../../../../src/threepoint/core/estimation/pose-estimator';
import { distance } from '../../../../src/threepoint/core/math/vec3';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { cases } from '../../../nightly';
import { evenly, seed, standpoint } from '../arbitraries';
import { type Joints, showAll } from './drawn';
import { movingPerson } from './moving-person';
import { openPlainModel, openShippedModel } from './shipped-models';

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

/** The subjects that show a body. */
export const bodies = subjects.filter(({ name }) => name !== 'hands-only');

/** The subjects whose torso and arms are fitted to head and hands; section 3.5 of the paper fits neither. */
export const fitted = bodies.filter(({ name }) => name !== 'paper-published');

/**
 * Makes estimators of this subject for the tests of the suite that calls it: their network is opened before the first
 * and closed after the last.
 */
export function openSubject({ name, plain }: (typeof subjects)[number]) {
  const wantsModel = needsRegressor(name);
  let regressor: PoseRegressor | null = null;
  beforeAll(async () => {
    if (wantsModel) regressor = plain ? openPlainModel() : await openShippedModel(networkOf(name)!);
  });
  afterAll(() => regressor?.dispose());

  return {
    create: (calibration: Calibration, options?: PipelineOptions): PoseEstimator =>
      createEstimator(name, calibration, regressor, options),
    /** Inference costs: fewer cases where every frame runs a network, and none to shrink the one that fails. */
    runs: (most: number) => ({
      seed,
      ...(wantsModel ? { numRuns: cases(Math.ceil(most / 5)), endOnFailure: true } : { numRuns: cases(most) }),
    }),
  };
}
