import { describe, expect, test } from 'vitest';
import { type Calibration, calibrationFromHeadHeight } from '../../../../src/threepoint/core/body/calibration';
import { forwardKinematics } from '../../../../src/threepoint/core/body/forward-kinematics';
import { chestSpaceBody, skeletonFromCalibration } from '../../../../src/threepoint/core/body/skeleton';
import { createIk } from '../../../../src/threepoint/core/estimation/estimators';
import { makeIkSolution, makeThreePoints } from '../../../../src/threepoint/core/estimation/ik/solve-ik';
import {
  estimateHeadsetRise,
  makeHeadsetRiseState,
} from '../../../../src/threepoint/core/estimation/online-calibration/estimate-headset-rise';
import {
  unremarkable,
  usualReach,
} from '../../../../src/threepoint/core/estimation/online-calibration/headset-rise.json';
import { transformPoint } from '../../../../src/threepoint/core/math/pose';
import { fromAxisAngle } from '../../../../src/threepoint/core/math/quat';
import { sides } from '../../../../src/threepoint/core/math/side';
import {
  addScaled,
  distance,
  down,
  length,
  right,
  setVec3,
  subtract,
  up,
  vec3,
} from '../../../../src/threepoint/core/math/vec3';
import type { TrackingFrame } from '../../../../src/threepoint/core/tracking/tracking-frame';
import { poseOf } from './drawn';
import { type GoldenHeadsetRise, goldenHand, readGolden, vec } from './golden';
import { movingPerson, standing } from './moving-person';

const body: Calibration = { eyeHeight: 1.64, armSpan: 1.6 };
const skeleton = skeletonFromCalibration(body);

/**
 * From IK's shoulders straight down, as far as most arms hang; and those shoulders, which follow the hands a little.
 */
const hung = (() => {
  const shoulders = { left: vec3(-0.19, 1.4, 0), right: vec3(0.19, 1.4, 0) };
  const hands = { left: vec3(0, 0, 0), right: vec3(0, 0, 0) };
  for (let i = 0; i < 40; i++) {
    for (const side of sides) addScaled(shoulders[side], down, usualReach * chestSpaceBody(body).arm, hands[side]);
    const estimator = createIk(body);
    estimator.update(standing(body, hands.left, hands.right));
    const { floorFromHeading, ik } = estimator.state.solved;
    transformPoint(floorFromHeading, ik.joints.leftUpperArm, shoulders.left);
    transformPoint(floorFromHeading, ik.joints.rightUpperArm, shoulders.right);
  }
  return { shoulders, hands };
})();

/**
 * Arms that hang as far from the shoulders as most do, under a headset that sits higher by `rise` [m]; the hands lower
 * by `further`.
 */
function hanging(rise: number, further = 0): TrackingFrame {
  const frame = standing(body, addScaled(hung.hands.left, down, further), addScaled(hung.hands.right, down, further));
  return { ...frame, head: { ...frame.head, position: addScaled(frame.head.position, up, rise) } };
}

/** An estimator after so many seconds of this frame, at 20 frames a second. */
function estimatorAfter(seconds: number, frame: TrackingFrame, estimator = createIk(body)) {
  for (let i = 0; i < seconds * 20; i++) estimator.update({ ...frame, time: i / 20 });
  return estimator;
}

describe('a headset that sits above or below its usual place', () => {
  test.each([0.03, -0.03])(
    'by %f m is mostly observed within minutes, and brings the body nearer to the truth',
    (rise) => {
      const estimator = estimatorAfter(240, hanging(rise));
      const observed = estimator.state.headset.rise;
      expect(observed / rise).toBeGreaterThan(0.5);
      expect(observed / rise).toBeLessThan(1.1);
      const off = (of: ReturnType<typeof createIk>) =>
        distance(
          forwardKinematics(skeleton, poseOf(of, { ...hanging(rise), time: 1000 }).body!).rightUpperArm.position,
          hung.shoulders.right,
        );
      expect(off(estimator)).toBeLessThan(0.6 * off(createIk(body)));
    },
  );

  test('nothing is observed with a headset in place, in a moment, or by raised hands', () => {
    expect(estimatorAfter(240, hanging(0)).state.headset.rise).toBe(0);
    expect(estimatorAfter(4, hanging(0.03)).state.headset.rise).toBe(0);
    const raised = standing(body, vec3(-0.3, 1.2, -0.4), vec3(0.3, 1.2, -0.4));
    expect(estimatorAfter(60, raised).state.headset).toEqual(createIk(body).state.headset);
  });

  test('nothing is observed where the span was not measured: the arms may be longer', () => {
    const derived = { ...body, armSpan: calibrationFromHeadHeight(body.eyeHeight).armSpan };
    expect(estimatorAfter(60, hanging(0.03), createIk(derived)).state.headset.rise).toBe(0);
    expect(estimatorAfter(60, hanging(0.03)).state.headset.rise).toBeGreaterThan(0);
  });

  test('no faster than a body is seen to move by it', () => {
    const estimator = createIk(body);
    let before = 0;
    for (let i = 0; i < 72 * 30; i++) {
      estimator.update({ ...hanging(0.03), time: i / 72 });
      const { rise } = estimator.state.headset;
      expect(Math.abs(rise - before)).toBeLessThan(0.002 / 72);
      before = rise;
    }
    expect(before).toBeGreaterThan(0.005);
  });

  test('lowers the head by it along its own up, and leaves hands where tracked', () => {
    const estimator = estimatorAfter(60, hanging(0.03));
    const observed = estimator.state.headset.rise;
    const frame = { ...movingPerson(4, body, { x: 0, z: 0, yaw: 0 })(0.5), time: 70 };
    const bowed = { ...frame, head: { ...frame.head, orientation: fromAxisAngle(right, -0.9) } };
    const { head, leftHand } = poseOf(estimator, bowed);
    const moved = subtract(head.position, bowed.head.position);
    expect(length(moved)).toBeCloseTo(observed, 9);
    expect(moved.y).toBeCloseTo(-observed * Math.cos(0.9), 9);
    expect(leftHand?.position).toEqual(bowed.leftHand?.position);
  });

  test('lasts over a recentre and a pause, and is forgotten with the calibration', () => {
    const estimator = estimatorAfter(60, hanging(0.03));
    const observed = estimator.state.headset.rise;
    expect(observed).toBeGreaterThan(0);
    estimator.reset();
    expect(estimator.state.headset.rise).toBe(observed);
    estimator.calibrate(body);
    expect(estimator.state.headset).toEqual(createIk(body).state.headset);
  });

  test('counts beyond what people differ by', () => {
    const estimator = estimatorAfter(240, hanging(0, (unremarkable / 2) * chestSpaceBody(body).arm));
    const { reach, rise } = estimator.state.headset;
    expect(reach.left).toBeGreaterThan(usualReach + unremarkable / 4);
    expect(rise).toBe(0);
  });
});

describe('TypeScript agrees with Python', () => {
  const { arm, frames } = readGolden<GoldenHeadsetRise>('headset-rise.json');
  test.each([0, 0.02])('frame by frame, under a head lowered by %f m', (lowered) => {
    const state = makeHeadsetRiseState();
    const points = makeThreePoints();
    const ik = makeIkSolution();
    for (const { seconds, reach, seen, hangingReach, rise } of frames) {
      const [left, right] = reach.map(vec);
      for (const side of sides)
        setVec3(ik.joints[side === 'left' ? 'leftUpperArm' : 'rightUpperArm'], 0.2, 1.4 - lowered, 0);
      addScaled(vec3(0.2, 1.4, 0), left!, arm, points.leftHand.position);
      addScaled(vec3(0.2, 1.4, 0), right!, arm, points.rightHand.position);
      const completed = { leftHand: goldenHand(seen[0] === true), rightHand: goldenHand(seen[1] === true) };
      estimateHeadsetRise(state, { completed, points, ik }, arm, lowered, seconds);
      expect(state.reach.left).toBeCloseTo(hangingReach[0]!, 9);
      expect(state.reach.right).toBeCloseTo(hangingReach[1]!, 9);
      expect(state.rise).toBeCloseTo(rise, 9);
    }
    expect(state.rise).toBeGreaterThan(0.005);
  });
});
