import { expect, test } from 'vitest';
import { comparisonsOf } from '../../../src/study/model/results/compare-conditions';
import { axisDomain } from '../../../src/study/pages/results/charts';

const nameOf = () => 'Q1';
const compared = (...values: readonly [readonly number[], readonly number[]]) =>
  comparisonsOf(
    [{ of: 'Q1', asked: null, unit: 'answer', hypothesis: null, values: { first: values[0], second: values[1] } }],
    () => ({
      test: null,
      ranks: null,
      equivalence: null,
    }),
  );

test('an axis has the ends of its scale while all intervals are within them', () => {
  const comparisons = compared([3, 3, 4], [3, 3, 3]);
  expect(axisDomain({ comparisons, nameOf, domain: [1, 5] })).toEqual([1, 5]);
});

test('an axis covers the intervals that reach beyond its scale', () => {
  // Means of 4 and 2 with t = 4.303 of 2 degrees of freedom and standard errors of 1.
  const comparisons = compared([5, 5, 2], [1, 1, 4]);
  const [low, high] = axisDomain({ comparisons, nameOf, domain: [1, 5] });
  expect(low).toBeCloseTo(2 - 4.303, 3);
  expect(high).toBeCloseTo(4 + 4.303, 3);
});

test('an axis of single values, which have no intervals, is that of the scale', () => {
  expect(axisDomain({ comparisons: compared([5], [1]), nameOf, domain: [1, 5] })).toEqual([1, 5]);
});
