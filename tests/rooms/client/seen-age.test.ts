import { describe, expect, test } from 'vitest';
import { seenOver, type Way } from '../../../bench/relay/ages';
import { printFigures } from '../../print-figures';

const seconds = 60;

function seen(way: Way, seed: number) {
  const figures = seenOver(way, seconds, seed);
  const { p50Ms, p95Ms, freezes, jerkRatio } = figures;
  const milliseconds = `${1000 * way.roundTrip} ± ${1000 * way.jitter} ms, ${100 * way.loss} % lost`;
  printFigures(`seen over ${milliseconds}`, { p50Ms, p95Ms, 'freezes a minute': freezes, jerkRatio });
  return { ...figures, beyondWayMs: p95Ms - 500 * way.roundTrip };
}

describe('the sight of others in a headset that is steady to 0.03 mm', () => {
  for (const roundTrip of [0, 0.05, 0.15]) {
    for (const jitter of [0, 0.005]) {
      test(`is at most 50 ms later than round trips of ${1000 * roundTrip} ± ${1000 * jitter} ms, and as smooth`, () => {
        for (const seed of [1, 2]) {
          const { beyondWayMs, freezes, jerkRatio } = seen({ roundTrip, jitter, loss: 0 }, seed);
          expect(beyondWayMs).toBeLessThanOrEqual(50);
          expect(freezes).toBe(0);
          expect(jerkRatio).toBeLessThanOrEqual(1.1);
        }
      });
    }

    test(`freezes under once a minute at ${1000 * roundTrip} ± 20 ms with 2 % of losses, moving smoothly`, () => {
      for (const seed of [1, 2]) {
        const { freezes, jerkRatio } = seen({ roundTrip, jitter: 0.02, loss: 0.02 }, seed);
        expect(freezes).toBeLessThan(1);
        expect(jerkRatio).toBeLessThanOrEqual(1.1);
      }
    });
  }
});
