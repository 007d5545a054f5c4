import { skeletonFromCalibration } from 'threepoint';
import { createEstimator } from 'threepoint/core';
import { expect, test } from 'vitest';

const centimetres = { eyeHeight: 165, armSpan: 156 };

test.each([
  ['a skeleton', skeletonFromCalibration],
  ['an estimator', (person: typeof centimetres) => createEstimator('ik', person)],
])('%s of measures in centimetres is refused with the measures in metres', (_, create) => {
  expect(() => create(centimetres)).toThrow(RangeError);
  expect(() => create(centimetres)).toThrow(/165 cm are 1\.65 m/);
});
