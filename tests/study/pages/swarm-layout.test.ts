import fc from 'fast-check';
import { expect, test } from 'vitest';
import { swarmOffsets } from '../../../src/study/pages/results/swarm-layout';

const apart = (values: readonly number[], beside: readonly number[]) => {
  let least = Number.POSITIVE_INFINITY;
  for (let a = 0; a < values.length; a++) {
    for (let b = 0; b < a; b++) {
      const across = (beside[a] as number) - (beside[b] as number);
      least = Math.min(least, Math.hypot((values[a] as number) - (values[b] as number), across));
    }
  }
  return least;
};

test('dots that are far from each other stand in the middle of their strip', () => {
  expect(swarmOffsets([7, 1, 3], 5)).toEqual([0, 0, 0]);
});

test('alike values stand side by side, right and left of the first in turn', () => {
  expect(swarmOffsets([4, 4, 4], 5)).toEqual([0, 1, -1]);
});

test('no dot hides another where the strip is wide enough', () => {
  const values = fc.array(fc.integer({ min: 0, max: 60 }), { maxLength: 40 });
  fc.assert(
    fc.property(values, (sevenths) => {
      const given = sevenths.map((value) => value / 7);
      expect(apart(given, swarmOffsets(given, 100))).toBeGreaterThan(1 - 1e-6);
    }),
  );
});

test('a swarm that is wider than its strip is pushed together, and stays in it', () => {
  const beside = swarmOffsets(
    Array.from({ length: 30 }, () => 4),
    5,
  );
  expect(Math.max(...beside.map(Math.abs))).toBeCloseTo(2, 9);
  expect(new Set(beside.map((one) => one.toFixed(6))).size).toBe(30);
});
