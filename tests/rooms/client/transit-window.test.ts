import { createRandom } from 'threepoint/math';
import { expect, test } from 'vitest';
import { TransitWindow } from '../../../src/rooms/client/transit-window';

test('the transits of the last seconds are ranked as by a sort, packet after packet', () => {
  const window = new TransitWindow(5);
  expect([window.minimum, window.jitter]).toEqual([0, 0]);
  const chance = createRandom(11);
  let known: { readonly at: number; readonly transit: number }[] = [];
  let at = 0;
  for (let i = 0; i < 3000; i++) {
    // Sometimes so many at once that its memory has to grow, sometimes a silence longer than it remembers.
    at += i % 700 === 0 ? 6 : chance() * (i < 1500 ? 0.01 : 0.06);
    const transit = Math.round(20 * chance()) / 100 - 3;
    window.add(at, transit);
    known = [...known, { at, transit }].filter((one) => at - one.at <= 5);
    const sorted = known.map((one) => one.transit).sort((a, b) => a - b);
    expect(window.minimum).toBe(sorted[0]);
    expect(window.jitter).toBeCloseTo(sorted[Math.floor(sorted.length * 0.95)]! - sorted[0]!, 12);
  }
  window.clear();
  expect([window.minimum, window.jitter]).toEqual([0, 0]);
});
