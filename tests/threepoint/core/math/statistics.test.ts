import { expect, test } from 'vitest';
import { mean, median, quantile } from '../../../../src/threepoint/core/math/statistics';

test('statistics are those of numpy; of no values they are NaN', () => {
  const values = [10, 2, 4, 8];
  expect([mean(values), median(values)]).toEqual([6, 6]);
  // numpy.quantile([10, 2, 4, 8], [0, 0.3, 0.95, 1])
  expect([0, 0.3, 0.95, 1].map((share) => quantile(values, share))).toEqual([2, 3.8, expect.closeTo(9.7, 12), 10]);
  expect(values).toEqual([10, 2, 4, 8]);
  expect([mean([]), median([])]).toEqual([Number.NaN, Number.NaN]);
});
