import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import type { Calibration } from '../../../src/core/body/calibration';
import { handTiltOf, isBelievableTilt, turnOfTilt } from '../../../src/core/body/hand-tilt';
import { createEstimator } from '../../../src/core/estimation/estimators';
import { conjugate, multiply, rotate } from '../../../src/core/math/quat';
import { distance, forward, scale } from '../../../src/core/math/vec3';
import type { TrackingFrame } from '../../../src/core/tracking/tracking-frame';
import { number, seed } from '../arbitraries';
import { poseOf } from './drawn';
import { movingPerson } from './moving-person';
import { openPlainModel } from './shipped-models';

const body: Calibration = { eyeHeight: 1.58, armSpan: 1.5 };
const tilt = fc.record({ pitch: number(-0.5, 0.5), yaw: number(-0.5, 0.5) });
const straight = { pitch: 0, yaw: 0 };

/** The frame as devices tell it whose hands stand at these tilts to the forearms. */
const worn = (frame: TrackingFrame, left: typeof straight, right: typeof straight): TrackingFrame => {
  const turned = (hand: TrackingFrame['leftHand'], by: typeof straight) =>
    hand && { ...hand, orientation: multiply(hand.orientation, conjugate(turnOfTilt(by))) };
  return { ...frame, leftHand: turned(frame.leftHand, left), rightHand: turned(frame.rightHand, right) };
};

describe('hands that stand at a tilt to their forearms', () => {
  test('a tilt is where its turn takes −Z, however long the forearm', () => {
    fc.assert(
      fc.property(tilt, number(0.1, 2), (given, metres) => {
        const found = handTiltOf(scale(rotate(turnOfTilt(given), forward), metres));
        expect(found.pitch).toBeCloseTo(given.pitch, 9);
        expect(found.yaw).toBeCloseTo(given.yaw, 9);
      }),
      { seed },
    );
  });

  test('up is pitch and to the left is yaw', () => {
    expect(rotate(turnOfTilt({ pitch: 0.3, yaw: 0 }), forward).y).toBeGreaterThan(0.2);
    expect(rotate(turnOfTilt({ pitch: 0, yaw: 0.3 }), forward).x).toBeLessThan(-0.2);
    expect(handTiltOf(forward)).toEqual({ pitch: 0, yaw: -0 });
  });

  test('a wrist bent by 57° and more is no tilt of a hand', () => {
    expect(isBelievableTilt({ pitch: 0.6, yaw: 0.7 })).toBe(true);
    expect(isBelievableTilt({ pitch: -0.8, yaw: 0.7 })).toBe(false);
    expect(isBelievableTilt({ pitch: Number.NaN, yaw: 0 })).toBe(false);
  });

  test.each([
    ['ik', null, 1e-9],
    // Its features and answers are 32-bit numbers.
    ['learned', openPlainModel(), 1e-7],
  ] as const)('have the elbows of hands that stand straight, once calibration knows: %s', (name, network, apart) => {
    fc.assert(
      fc.property(tilt, tilt, fc.integer({ min: 0, max: 1000 }), (left, right, who) => {
        const person = movingPerson(who, body, { x: 0, z: 0, yaw: 0.4 });
        const level = createEstimator(name, { ...body, handTilts: { left: straight, right: straight } }, network);
        const tilted = createEstimator(name, { ...body, handTilts: { left, right } }, network);
        for (let i = 0; i < 30; i++) {
          const frame = person(i / 60);
          const wanted = poseOf(level, frame);
          const drawn = poseOf(tilted, worn(frame, left, right));
          if (!drawn.body || !wanted.body) throw new Error(`${name} draws a body`);
          expect(distance(drawn.body.hipsPosition, wanted.body.hipsPosition)).toBeLessThan(1e-5);
          for (const upperArm of ['leftUpperArm', 'rightUpperArm'] as const) {
            const [a, b] = [drawn.body.localRotations[upperArm], wanted.body.localRotations[upperArm]];
            expect(Math.abs(a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w)).toBeGreaterThan(1 - apart);
          }
        }
      }),
      { seed, numRuns: 20 },
    );
  });

  test('are told to the learned network: a hand that was found straight is not one of which nothing is known', () => {
    const frame = movingPerson(6, body, { x: 0, z: 0, yaw: 0 })(1);
    const network = openPlainModel();
    const hipsOf = (handTilts: Calibration['handTilts']) => {
      const estimator = createEstimator('learned', { ...body, handTilts }, network);
      poseOf(estimator, { ...frame, time: frame.time - 1 / 60 });
      const { body: drawn } = poseOf(estimator, frame);
      if (!drawn) throw new Error('the learned network draws a body');
      return drawn.hipsPosition;
    };
    expect(distance(hipsOf({ left: straight, right: straight }), hipsOf(undefined))).toBeGreaterThan(1e-4);
  });

  test('are drawn where and as they are tracked', () => {
    const estimator = createEstimator('ik', { ...body, handTilts: { left: { pitch: 0.4, yaw: -0.2 } } });
    const frame = movingPerson(4, body, { x: 0, z: 0, yaw: 0 })(1);
    const drawn = poseOf(estimator, frame);
    expect(drawn.leftHand).toEqual(frame.leftHand);
  });

  test('one hand may be measured and the other not', () => {
    const frame = movingPerson(5, body, { x: 0, z: 0, yaw: 0 })(1);
    const rotationsOf = (handTilts: Calibration['handTilts']) =>
      poseOf(createEstimator('ik', { ...body, handTilts }), frame).body?.localRotations;
    const [none, left] = [rotationsOf(undefined), rotationsOf({ left: { pitch: 0.4, yaw: 0 } })];
    expect(left?.leftUpperArm).not.toEqual(none?.leftUpperArm);
    expect(left?.rightUpperArm).toEqual(none?.rightUpperArm);
  });
});
