import fc from 'fast-check';
import { type Calibration, createEstimator, type TrackingFrame } from 'threepoint/core';
import { angleBetween, conjugate, distance, forward, multiply, type Quat, rotate, scale, sides } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { handTiltOf, isPlausibleTilt, tiltRotation } from '../../../../src/threepoint/core/body/hand-tilt';
import { createIk } from '../../../../src/threepoint/core/estimation/estimators';
import { number, seed } from '../arbitraries';
import { poseOf } from './drawn';
import { movingPerson } from './moving-person';
import { openPlainModel } from './shipped-models';

const body: Calibration = { eyeHeight: 1.58, armSpan: 1.5 };
const tilt = fc.record({ pitch: number(-0.5, 0.5), yaw: number(-0.5, 0.5) });
const straight = { pitch: 0, yaw: 0 };
/** No motion of the hands is observed before the second frame. */
const framesAsTold = 2;

/** Returns the frame of a device whose hands have these tilts to the forearms. */
const worn = (frame: TrackingFrame, left: typeof straight, right: typeof straight): TrackingFrame => {
  const turned = (hand: TrackingFrame['leftHand'], by: typeof straight) =>
    hand && { ...hand, orientation: multiply(hand.orientation, conjugate(tiltRotation(by))) };
  return { ...frame, leftHand: turned(frame.leftHand, left), rightHand: turned(frame.rightHand, right) };
};

describe('hands that stand at a tilt to their forearms', () => {
  test('a tilt is where its turn takes −Z, however long the forearm', () => {
    fc.assert(
      fc.property(tilt, number(0.1, 2), (given, metres) => {
        const found = handTiltOf(scale(rotate(tiltRotation(given), forward), metres));
        expect(found.pitch).toBeCloseTo(given.pitch, 9);
        expect(found.yaw).toBeCloseTo(given.yaw, 9);
      }),
      { seed },
    );
  });

  test('up is pitch and to the left is yaw', () => {
    expect(rotate(tiltRotation({ pitch: 0.3, yaw: 0 }), forward).y).toBeGreaterThan(0.2);
    expect(rotate(tiltRotation({ pitch: 0, yaw: 0.3 }), forward).x).toBeLessThan(-0.2);
    expect(handTiltOf(forward)).toEqual({ pitch: 0, yaw: -0 });
  });

  test('a wrist bent by 57° and more is no tilt of a hand', () => {
    expect(isPlausibleTilt({ pitch: 0.6, yaw: 0.7 })).toBe(true);
    expect(isPlausibleTilt({ pitch: -0.8, yaw: 0.7 })).toBe(false);
    expect(isPlausibleTilt({ pitch: Number.NaN, yaw: 0 })).toBe(false);
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
        for (let i = 0; i < framesAsTold; i++) {
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

  test('are drawn where and as they are tracked', () => {
    const estimator = createEstimator('ik', { ...body, handTilts: { left: { pitch: 0.4, yaw: -0.2 } } });
    const frame = movingPerson(4, body, { x: 0, z: 0, yaw: 0 })(1);
    const drawn = poseOf(estimator, frame);
    expect(drawn.leftHand).toEqual(frame.leftHand);
  });

  test('one hand may be calibrated and the other not', () => {
    const frame = movingPerson(5, body, { x: 0, z: 0, yaw: 0 })(1);
    const rotationsOf = (handTilts: Calibration['handTilts']) =>
      poseOf(createEstimator('ik', { ...body, handTilts }), frame).body?.localRotations;
    const [none, left] = [rotationsOf(undefined), rotationsOf({ left: { pitch: 0.4, yaw: 0 } })];
    expect(left?.leftUpperArm).not.toEqual(none?.leftUpperArm);
    expect(left?.rightUpperArm).toEqual(none?.rightUpperArm);
  });
});

describe('tilts that are estimated while hands move', () => {
  /** How hands are turned after so many seconds of a person who wears them so. */
  const estimated = (seconds: number, told: Calibration['handTilts'], left = straight, right = straight) => {
    const estimator = createIk({ ...body, handTilts: told });
    const person = movingPerson(7, body, { x: 0, z: 0, yaw: 0.3 });
    for (let i = 0; i <= seconds * 60; i++) estimator.update(worn(person(i / 60), left, right));
    return estimator.state.tilts.turns;
  };
  const degreesFrom = (found: Quat, { pitch, yaw }: typeof straight) =>
    (angleBetween(found, tiltRotation({ pitch, yaw })) * 180) / Math.PI;

  test('are at first the calibrated ones, else the usual ones, a left hand’s the mirror image', () => {
    const told = { pitch: 0.3, yaw: -0.2 };
    const { left, right } = estimated(0, { left: told });
    expect(left).toBeSameRotationAs(tiltRotation(told), 1e-6);
    const { pitch, yaw } = handTiltOf(rotate(right, forward));
    expect(handTiltOf(rotate(estimated(0, undefined).left, forward))).toEqual({
      pitch: expect.closeTo(pitch, 9),
      yaw: expect.closeTo(-yaw, 9),
    });
  });

  test('come within 15° of how hands are worn, wherever they begin', () => {
    const [left, right] = [
      { pitch: 0.3, yaw: 0.4 },
      { pitch: 0.3, yaw: -0.4 },
    ];
    const usual = estimated(0, undefined, left, right);
    expect(degreesFrom(usual.left, left)).toBeGreaterThan(40);
    expect(degreesFrom(usual.right, right)).toBeGreaterThan(40);
    for (const told of [undefined, { left: { pitch: -0.4, yaw: -0.4 }, right: { pitch: 0.6, yaw: 0.4 } }]) {
      const found = estimated(120, told, left, right);
      expect(degreesFrom(found.left, left)).toBeLessThan(15);
      expect(degreesFrom(found.right, right)).toBeLessThan(15);
    }
  });

  test('do not feed themselves: after minutes it makes little difference what was calibrated', () => {
    const [usual, told] = [undefined, { left: { pitch: 0.5, yaw: 0.5 }, right: { pitch: 0.5, yaw: 0.5 } }].map((told) =>
      estimated(180, told),
    );
    for (const side of sides) expect(told![side]).toBeSameRotationAs(usual![side], 6);
  });

  test('stay while a hand is not seen', () => {
    const estimator = createIk(body);
    const person = movingPerson(8, body, { x: 0, z: 0, yaw: 0 });
    const at = (i: number, leftHand?: null) => ({ ...person(i / 60), ...(leftHand === null && { leftHand }) });
    for (let i = 0; i < 60; i++) estimator.update(at(i));
    const before = structuredClone(estimator.state.tilts.turns);
    for (let i = 60; i < 180; i++) estimator.update(at(i, null));
    expect(estimator.state.tilts.turns.left).toEqual(before.left);
    expect(estimator.state.tilts.turns.right).not.toEqual(before.right);
  });

  test('stay over a recentre and a pause, and are reset by a calibration', () => {
    const estimator = createIk(body);
    const person = movingPerson(8, body, { x: 0, z: 0, yaw: 0 });
    const { turns } = estimator.state.tilts;
    const usual = structuredClone(turns);
    for (let i = 0; i < 60; i++) estimator.update(person(i / 60));
    const estimated = structuredClone(turns);
    expect(estimated).not.toEqual(usual);
    estimator.reset();
    estimator.update(person(1));
    estimator.update(person(20));
    expect(turns).toEqual(estimated);
    estimator.calibrate(body);
    expect(turns).toEqual(usual);
  });

  test('are the same at any frame rate', () => {
    const at = (rate: number) => {
      const estimator = createIk(body);
      const person = movingPerson(9, body, { x: 0, z: 0, yaw: 0 });
      for (let i = 0; i <= 5 * rate; i++) estimator.update(person(i / rate));
      return estimator.state.tilts.turns;
    };
    const [slow, fast] = [at(60), at(120)];
    for (const side of sides) expect(fast[side]).toBeSameRotationAs(slow[side], 0.5);
  });
});
