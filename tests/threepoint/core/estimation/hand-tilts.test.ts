import fc from 'fast-check';
import { type Calibration, createEstimator, type TrackingFrame } from 'threepoint/core';
import { add, angleBetween, conjugate, distance, forward, multiply, rotate, scale, sides, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import {
  defaultHandTilt,
  handTiltOf,
  isPlausibleTilt,
  tiltRotation,
} from '../../../../src/threepoint/core/body/hand-tilt';
import { createIk } from '../../../../src/threepoint/core/estimation/estimators';
import { number, seed } from '../arbitraries';
import { jointsOf } from './contract-subjects';
import { poseOf } from './drawn';
import { movingPerson } from './moving-person';
import { openPlainModel } from './shipped-models';

const body: Calibration = { eyeHeight: 1.58, armSpan: 1.5 };
const tilt = fc.record({ pitch: number(-0.5, 0.5), yaw: number(-0.5, 0.5) });
const straight = { pitch: 0, yaw: 0 };

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
    ['ik', null],
    ['learned', openPlainModel()],
  ] as const)('have elbows nearer to those of straight hands, once calibration knows: %s', (name, network) => {
    const apart = { known: 0, unknown: 0 };
    fc.assert(
      fc.property(tilt, tilt, fc.integer({ min: 0, max: 1000 }), (left, right, who) => {
        const person = movingPerson(who, body, { x: 0, z: 0, yaw: 0.4 });
        const level = createEstimator(name, { ...body, handTilts: { left: straight, right: straight } }, network);
        const tilted = {
          known: createEstimator(name, { ...body, handTilts: { left, right } }, network),
          unknown: createEstimator(name, { ...body, handTilts: { left: straight, right: straight } }, network),
        };
        for (let i = 0; i < 60; i++) {
          const frame = person(i / 60);
          const wanted = jointsOf(poseOf(level, frame), body);
          for (const calibrated of ['known', 'unknown'] as const) {
            const drawn = jointsOf(poseOf(tilted[calibrated], worn(frame, left, right)), body);
            for (const side of sides) {
              const elbow = `${side}LowerArm` as const;
              apart[calibrated] += distance(drawn[elbow].position, wanted[elbow].position);
            }
          }
        }
      }),
      { seed, numRuns: 20 },
    );
    expect(apart.unknown).toBeGreaterThan(0);
    expect(apart.known).toBeLessThan(0.2 * apart.unknown);
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

describe('tilts that are estimated while hands are seen', () => {
  /** How hands are turned on average over some seconds of a person who wears them so. */
  const estimated = (seconds: number, told: Calibration['handTilts'], left = straight, right = straight) => {
    const estimator = createIk({ ...body, handTilts: told });
    const person = movingPerson(7, body, { x: 0, z: 0, yaw: 0.3 });
    const mean = { left: vec3(0, 0, 0), right: vec3(0, 0, 0) };
    for (let i = 0; i <= seconds * 60; i++) {
      estimator.update(worn(person(i / 60), left, right));
      for (const side of sides) add(mean[side], rotate(estimator.state.tilts.turns[side], forward), mean[side]);
    }
    return { left: handTiltOf(mean.left), right: handTiltOf(mean.right) };
  };
  const degreesFrom = (found: typeof straight, told: typeof straight) =>
    (angleBetween(tiltRotation(found), tiltRotation(told)) * 180) / Math.PI;

  test('are the calibrated ones, or else mirror images, until the hand is seen', () => {
    const told = { pitch: 0.3, yaw: -0.2 };
    const unseen = (handTilts: Calibration['handTilts']) => {
      const estimator = createIk({ ...body, handTilts });
      estimator.update({ ...movingPerson(7, body, { x: 0, z: 0, yaw: 0.3 })(0), leftHand: null, rightHand: null });
      return estimator.state.tilts.turns;
    };
    expect(unseen({ left: told }).left).toBeSameRotationAs(tiltRotation(told), 1e-6);
    const { pitch, yaw } = handTiltOf(rotate(unseen(undefined).right, forward));
    expect(handTiltOf(rotate(unseen(undefined).left, forward))).toEqual({
      pitch: expect.closeTo(pitch, 9),
      yaw: expect.closeTo(-yaw, 9),
    });
  });

  test('come half of the way to how hands are worn', () => {
    const [left, right] = [
      { pitch: 0.3, yaw: 0.4 },
      { pitch: 0.3, yaw: -0.4 },
    ];
    const found = estimated(60, undefined, left, right);
    for (const [side, told] of [['left', left] as const, ['right', right] as const]) {
      expect(degreesFrom(defaultHandTilt(side), told)).toBeGreaterThan(40);
      expect(degreesFrom(found[side], told)).toBeLessThan(0.5 * degreesFrom(defaultHandTilt(side), told));
    }
  });

  test('are nearer to a calibrated tilt than to the usual one', () => {
    const told = { left: { pitch: 0.5, yaw: 0.5 }, right: { pitch: 0.5, yaw: 0.5 } };
    const [known, unknown] = [estimated(60, told), estimated(60, undefined)];
    for (const side of sides) {
      expect(degreesFrom(known[side], told[side])).toBeLessThan(degreesFrom(unknown[side], told[side]));
    }
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

  test.each([
    ['a recentre', (estimator: ReturnType<typeof createIk>) => estimator.reset()],
    ['a pause', () => undefined],
    ['a calibration', (estimator: ReturnType<typeof createIk>) => estimator.calibrate(body)],
  ] as const)('are those of a new body after %s', (_, interrupt) => {
    const [estimator, fresh] = [createIk(body), createIk(body)];
    const person = movingPerson(8, body, { x: 0, z: 0, yaw: 0 });
    for (let i = 0; i < 60; i++) estimator.update(person(i / 60));
    interrupt(estimator);
    estimator.update(person(20));
    fresh.update(person(20));
    expect(estimator.state.tilts.turns).toEqual(fresh.state.tilts.turns);
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
