import { expect, test } from 'vitest';
import { copyJoints, type JointPositions, mapJoints } from '../../../../src/threepoint/core/estimation/joint-positions';
import {
  limitJoints,
  makeLimitJointsState,
  resetLimitJoints,
} from '../../../../src/threepoint/core/estimation/limit-joints';
import { fromAxisAngle, identity, type Quat, rotate } from '../../../../src/threepoint/core/math/quat';
import { add, distance, subtract, up, type Vec3, vec3 } from '../../../../src/threepoint/core/math/vec3';
import { fromEulerYxz } from '../euler-angles';
import { completedFrame } from './drawn';

const calibration = { eyeHeight: 1.6, armSpan: 1.5 };
const head = vec3(0, 1.62, 0);
const around = (place: Vec3): JointPositions => mapJoints((_, index) => add(place, vec3(0.1 * index, -0.1 * index, 0)));
const turnedAbout = (joints: JointPositions): JointPositions => ({
  ...joints,
  hips: add(joints.hips, vec3(0, 0, -0.6)),
  leftLowerArm: add(joints.leftLowerArm, vec3(0, 0, -0.6)),
});

interface Frame {
  readonly position?: Vec3;
  readonly orientation?: Quat;
  /** Confidence in the left hand, which is tracked. */
  readonly confidence?: number;
  readonly jumped?: boolean;
  readonly bodyTurn?: Quat;
}

/** The stage, whose answers are kept. */
function stage() {
  const state = makeLimitJointsState();
  return {
    follow(joints: JointPositions, deltaSeconds: number, frame: Frame = {}): JointPositions {
      const { position = head, orientation = identity, confidence = 1, jumped = false, bodyTurn = identity } = frame;
      const pose = { position, orientation };
      const completed = completedFrame({ head: pose, leftHand: pose, rightHand: pose }, calibration);
      const leftHand = { ...completed.leftHand, confidence, jumped };
      return copyJoints(limitJoints(state, joints, { ...completed, leftHand, bodyTurn }, deltaSeconds));
    },
    reset: () => resetLimitJoints(state),
  };
}

test('joints pass unchanged while head and hands are certain, however far they jump', () => {
  const limited = stage();
  for (const joints of [around(head), turnedAbout(around(head)), around(vec3(3, 1, -2))])
    expect(limited.follow(joints, 1 / 60)).toEqual(mapJoints((joint) => add(head, subtract(joints[joint], head))));
});

test('the first frame, and the first after a reset, passes unchanged whatever the doubt', () => {
  const limited = stage();
  const unsure = { confidence: 0 };
  expect(limited.follow(around(head), 0, unsure)).toEqual(around(head));
  limited.reset();
  expect(
    distance(limited.follow(turnedAbout(around(head)), 1 / 60, unsure).hips, turnedAbout(around(head)).hips),
  ).toBeLessThan(1e-12);
});

test('the trunk moves 1 cm a frame at most after a displaced hand, faster with confidence', () => {
  const limited = stage();
  let before = limited.follow(around(head), 0);
  const goal = turnedAbout(around(head));
  const step = (confidence: number) => {
    const shown = limited.follow(goal, 1 / 60, { confidence });
    const far = distance(shown.hips, before.hips);
    before = shown;
    return far;
  };
  expect(step(0)).toBeCloseTo(0.01, 9);
  expect(step(0.5)).toBeCloseTo(1.55 / 60, 9);
  expect(step(1)).toBeCloseTo(2.5 / 60, 9);
  for (let i = 0; i < 15; i++) step(1);
  expect(distance(before.hips, goal.hips)).toBeLessThan(1e-12);
  // Once they have caught up they are free again.
  expect(distance(limited.follow(around(head), 1 / 60).hips, around(head).hips)).toBeLessThan(1e-12);
});

test('the trunk under a head on its side moves at most 1 cm in a frame', () => {
  const limited = stage();
  const aside = { orientation: fromEulerYxz(vec3(0, 0, -Math.PI / 2)) };
  const before = limited.follow(around(head), 0, aside);
  const shown = limited.follow(turnedAbout(around(head)), 1 / 60, aside);
  expect(distance(shown.hips, before.hips)).toBeLessThan(0.0101);
});

test('the elbow of the hand that jumps goes along at once', () => {
  const limited = stage();
  limited.follow(around(head), 0);
  const goal = turnedAbout(around(head));
  const shown = limited.follow(goal, 1 / 60, { confidence: 0, jumped: true });
  expect(distance(shown.leftLowerArm, goal.leftLowerArm)).toBeLessThan(1e-12);
  expect(distance(shown.hips, goal.hips)).toBeGreaterThan(0.5);
});

test('a body that turns under an uncertain hand carries its joints along', () => {
  const limited = stage();
  limited.follow(around(head), 0);
  const bodyTurn = fromAxisAngle(up, 0.2);
  const turned = mapJoints((joint) => add(head, rotate(bodyTurn, subtract(around(head)[joint], head))));
  const shown = limited.follow(turned, 1 / 60, { confidence: 0, bodyTurn });
  expect(distance(shown.hips, turned.hips)).toBeLessThan(1e-12);
});

test('a head that moves carries its joints along, whatever the doubt', () => {
  const limited = stage();
  limited.follow(around(head), 0, { confidence: 0 });
  const there = vec3(0.5, 1.62, 0.2);
  const shown = limited.follow(around(there), 1 / 60, { confidence: 0, position: there });
  expect(distance(shown.hips, around(there).hips)).toBeLessThan(1e-12);
});
