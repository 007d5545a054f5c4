import { expect, test } from 'vitest';
import { pairedRatio } from '../../bench/paired-ratio';

test('a cost that is always twice another is twice it, without doubt', () => {
  const { ratio, low, high, pairs } = pairedRatio([2, 4, 10], [1, 2, 5]);
  for (const value of [ratio, low, high]) expect(value).toBeCloseTo(2, 12);
  expect(pairs).toBe(3);
});

test('a machine that is ten times slower in one pair changes nothing, as both are slower', () => {
  const calm = pairedRatio([1.1, 1.0, 1.2, 1.1], [1, 1, 1, 1]);
  const busy = pairedRatio([1.1, 10, 1.2, 1.1], [1, 10, 1, 1]);
  expect(busy.ratio).toBeCloseTo(calm.ratio, 12);
  expect(busy.high).toBeCloseTo(calm.high, 12);
});

test('three pairs at 0.5, 1 and 2 are at 1, between 0.18 and 5.6', () => {
  // t of two degrees of freedom is 4.303, the logarithms deviate by ln 2: 2^(4.303/√3).
  const { ratio, low, high } = pairedRatio([1, 1, 2], [2, 1, 1]);
  expect(ratio).toBeCloseTo(1, 12);
  expect(high).toBeCloseTo(5.595, 2);
  expect(low).toBeCloseTo(1 / 5.595, 3);
});

test('one pair says nothing of how sure it is', () => {
  expect(pairedRatio([1], [2]).ratio).toBeNaN();
});
