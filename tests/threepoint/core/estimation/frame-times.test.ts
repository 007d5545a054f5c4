import { createEstimator, defaultCalibration } from 'threepoint/core';
import { expect, test } from 'vitest';
import { numbersIn } from '../numbers-in';
import { poseOf } from './drawn';
import { movingPerson } from './moving-person';
import { openPlainModel } from './shipped-models';

const at = movingPerson(5, defaultCalibration, { x: 0.5, z: 1, yaw: -2 });

test.each([
  ['ik', null],
  ['learned', openPlainModel()],
] as const)('a time that is no number is a gap without NaN, then or afterwards: %s', (name, network) => {
  const estimator = createEstimator(name, defaultCalibration, network);
  for (let i = 0; i < 120; i++) {
    const pose = poseOf(estimator, i === 20 ? { ...at(i / 60), time: Number.NaN } : at(i / 60));
    expect(numbersIn(pose).every(Number.isFinite)).toBe(true);
  }
  expect(estimator.fault()).toBeNull();
});
