import {
  actorFrame,
  armBonesOf,
  armSpanFromFingertipSpan,
  type Calibration,
  createEstimator,
  eyeHeightFromStature,
  forwardKinematics,
  initialGuidedCalibration,
  jointNames,
  skeletonFromCalibration,
  stepGuidedCalibration,
  type TrackingFrame,
} from 'threepoint/core';
import { add, distance, identity, subtract, type TrackedPose, type Vec3, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { poseOf } from '../threepoint/core/estimation/drawn';
import { reportFigures } from './report-figures';

const statures = [1.1, 1.2, 1.35, 1.5, 1.7, 1.9, 2.1, 2.2];
const bodyOf = (stature: number): Calibration => ({
  eyeHeight: eyeHeightFromStature(stature),
  armSpan: armSpanFromFingertipSpan(stature),
});

const tracked = (position: Vec3): TrackedPose => ({ position, orientation: identity, tracking: 'tracked' });
const sunk = (frame: TrackingFrame, by: number): TrackingFrame => {
  const lower = <Pose extends TrackedPose | null>(pose: Pose): Pose =>
    (pose && { ...pose, position: subtract(pose.position, vec3(0, by, 0)) }) as Pose;
  return { ...frame, head: lower(frame.head), leftHand: lower(frame.leftHand), rightHand: lower(frame.rightHand) };
};

/** Returns the tracking of a person who stands straight and stretches both arms forward. */
function stretched(body: Calibration, time: number): TrackingFrame {
  const skeleton = skeletonFromCalibration(body);
  const upright = Object.fromEntries(jointNames.map((joint) => [joint, identity])) as Record<
    (typeof jointNames)[number],
    typeof identity
  >;
  const joints = forwardKinematics(skeleton, { hipsPosition: skeleton.restOffsets.hips, localRotations: upright });
  const moved = subtract(vec3(0, body.eyeHeight, 0), add(joints.head.position, skeleton.eyesInHead));
  const wrist = (side: 'left' | 'right') => {
    const { upper, lower } = armBonesOf(skeleton, side);
    return tracked(add(add(joints[`${side}UpperArm`].position, moved), vec3(0, 0, -upper - lower)));
  };
  return { time, head: tracked(vec3(0, body.eyeHeight, 0)), leftHand: wrist('left'), rightHand: wrist('right') };
}

/** Runs two seconds of the page's guided calibration; returns the message if it is rejected. */
function measuredInTwoSeconds(body: Calibration, lower: number): Calibration | string {
  let state = initialGuidedCalibration;
  for (let i = 0; i <= 2.1 * 72; i++) state = stepGuidedCalibration(state, sunk(stretched(body, 50 + i / 72), lower));
  if (state.kind === 'measuring') throw new Error('two seconds did not end the measuring');
  return state.kind === 'done' ? state.calibration : state.reason;
}

/** Measures the error of the drawn wrists and the lowest pelvis [m] while a person with this body plays. */
function wear(body: Calibration, calibration: Calibration, lower: number) {
  const estimator = createEstimator('ik', calibration);
  const skeleton = skeletonFromCalibration(calibration);
  let off = 0;
  let pelvis = Number.POSITIVE_INFINITY;
  for (let i = 0; i < 20 * 15; i++) {
    const frame = sunk(actorFrame(i / 15, body), lower);
    const joints = forwardKinematics(skeleton, poseOf(estimator, frame).body!);
    for (const hand of ['leftHand', 'rightHand'] as const) {
      const wrist = frame[hand];
      if (wrist) off = Math.max(off, distance(joints[hand].position, wrist.position));
    }
    pelvis = Math.min(pelvis, joints.hips.position.y);
  }
  return { off, pelvis };
}

/** Returns the worst errors over all statures, each with the calibration of `calibrationOf`. */
function worn(lower: (body: Calibration) => number, calibrationOf: (body: Calibration) => Calibration) {
  const seen = statures.map(bodyOf).map((body) => wear(body, calibrationOf(body), lower(body)));
  return {
    off: Math.max(...seen.map(({ off }) => off)),
    pelvis: Math.min(...seen.map(({ pelvis }) => pelvis)),
  };
}

const figure = (how: string, { off, pelvis }: { readonly off: number; readonly pelvis: number }) =>
  `${how}, wrists ${(1000 * off).toFixed(2)} mm off, pelvis ${(100 * pelvis).toFixed(0)} cm above the floor at least`;

test.each([
  ['standing', () => 0],
  ['seated', ({ eyeHeight }: Calibration) => 0.28 * eyeHeight],
  ['crouching', ({ eyeHeight }: Calibration) => 0.45 * eyeHeight],
  ['a floor half a metre too high', () => 0.5],
] as const)('%s from 1.10 to 2.20 m: two seconds measure hands and a pelvis above the floor', (posture, lower) => {
  let guided = 0;
  const seen = worn(lower, (body) => {
    const found = measuredInTwoSeconds(body, lower(body));
    if (typeof found === 'string') throw new Error(`${body.eyeHeight}: ${found}`);
    guided += 1;
    return found;
  });
  expect(seen.pelvis).toBeGreaterThan(0);
  expect(seen.off).toBeLessThan(1e-3);
  reportFigures('people', { [posture]: figure(`measured in 2 s ${guided} of ${statures.length}`, seen) });
});

test('a floor half a metre too low measures no one wrongly; a typed height fits', () => {
  const lower = () => -0.5;
  // Stretched arms below a head that is too high are indistinguishable from bent arms of a taller person.
  for (const body of statures.map(bodyOf)) expect(measuredInTwoSeconds(body, lower())).toMatch(/type your height/);
  const seen = worn(lower, (body) => body);
  expect(seen.pelvis).toBeGreaterThan(0);
  expect(seen.off).toBeLessThan(1e-3);
  reportFigures('people', {
    'a floor half a metre too low': figure(
      `asked to type the height ${statures.length} of ${statures.length}; with it typed`,
      seen,
    ),
  });
});
