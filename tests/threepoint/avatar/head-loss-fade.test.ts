import { describe, expect, test } from 'vitest';
import { createHeadLossFade } from '../../../src/threepoint/avatar/head-loss-fade';
import { reportFigures } from '../../reliability/report-figures';

describe('a body whose head is lost', () => {
  test('stays solid for a moment, fades to a quarter, and is whole once the head returns', () => {
    for (const rate of [72, 80, 90, 120]) {
      const loss = createHeadLossFade();
      expect(loss.opacityAt(0, true)).toBe(1);
      const seen: number[] = [];
      for (let i = 1; i <= 3 * rate; i++) seen.push(loss.opacityAt(i / rate, false));
      expect(seen.slice(0, Math.floor(0.15 * rate)).every((opacity) => opacity === 1)).toBe(true);
      expect(seen.at(-1)).toBeCloseTo(0.25, 9);
      seen.forEach((opacity, i) => {
        expect(opacity).toBeLessThanOrEqual(seen[i - 1] ?? 1);
      });
      expect(loss.opacityAt(3 + 1 / rate, true)).toBe(1);
    }
    reportFigures('head-lost', { 'opacity after 3 s': 0.25, 'opacity in the first frame back': 1 });
  });

  test('lost again it restarts', () => {
    const loss = createHeadLossFade();
    loss.opacityAt(0, false);
    expect(loss.opacityAt(1, false)).toBeLessThan(0.3);
    loss.opacityAt(1.1, true);
    expect(loss.opacityAt(1.2, false)).toBe(1);
  });
});
