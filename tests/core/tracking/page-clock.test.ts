import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { createPageClock, longestStep, neverBack } from '../../../src/core/tracking/page-clock';

const frameMs = 1000 / 72;

/** The times of these time stamps [ms]; `read` goes with them. */
function timesOf(stamps: readonly number[]): readonly number[] {
  let read = stamps[0] ?? 0;
  const clock = createPageClock(() => read);
  return stamps.map((stamp) => {
    read = stamp;
    return clock.frame(stamp);
  });
}

describe('the page’s clock', () => {
  test('with any time stamps it goes on with every frame, and by half a second at most', () => {
    const steps = fc.oneof(
      { weight: 8, arbitrary: fc.double({ min: 5, max: 40, noNaN: true }) },
      fc.double({ min: -1e7, max: 1e7, noNaN: true }),
      fc.constant(0),
    );
    fc.assert(
      fc.property(fc.double({ min: 0, max: 1e9, noNaN: true }), fc.array(steps, { maxLength: 60 }), (start, by) => {
        const stamps = [start];
        for (const step of by) stamps.push((stamps.at(-1) ?? 0) + step);
        const times = timesOf(stamps);
        for (const [i, time] of times.entries()) {
          const passed = time - (times[i - 1] ?? time - 0.01);
          expect(passed).toBeGreaterThan(0);
          expect(passed).toBeLessThanOrEqual(longestStep + 1e-6);
        }
      }),
      { seed: 14 },
    );
  });

  test('with ordinary frames it is the device’s own, slow ones included', () => {
    const stamps = [1000, 1014, 1028, 1300, 1800, 1814];
    expect(timesOf(stamps)).toEqual(stamps.map((stamp) => expect.closeTo(stamp / 1000, 9)));
  });

  test('a step back and the correction are a frame and a pause', () => {
    const stamps = [50_000, 50_000 + frameMs, 45_000, 45_000 + frameMs, 50_000 + 4 * frameMs];
    const times = timesOf(stamps);
    const passed = times.slice(1).map((time, i) => time - (times[i] ?? 0));
    const frame = frameMs / 1000;
    expect(passed).toEqual([frame, frame, frame, longestStep].map((seconds) => expect.closeTo(seconds, 6)));
  });

  test('what is left out of a pause is told, of a step back nothing', () => {
    let read = 0;
    const clock = createPageClock(() => read);
    for (const stamp of [0, 16, 20_016]) {
      read = stamp;
      clock.frame(stamp);
    }
    expect([clock.paused, clock.leftOut]).toEqual([true, expect.closeTo(20 - longestStep, 9)]);
    clock.frame(16);
    expect([clock.paused, clock.leftOut]).toEqual([false, expect.closeTo(20 - longestStep, 9)]);
  });

  test('between frames it goes on with the browser’s, for as long as a frame may take, and no frame is before it', () => {
    let read = 5000;
    const clock = createPageClock(() => read);
    const first = clock.frame(4990);
    read = 5008;
    expect(clock.now()).toBeCloseTo(first + 0.008, 9);
    read = 65_000;
    expect(clock.now()).toBeCloseTo(first + longestStep, 9);
    read = 100;
    expect(clock.now()).toBeCloseTo(first + longestStep, 9);
    expect(clock.frame(64_990)).toBeGreaterThanOrEqual(first + longestStep);
  });
});

test('the time of day of a study goes on when the system’s is set back, and stays in order', () => {
  let read = 1_000_000;
  const now = neverBack(() => read);
  const heard = [1_000_010, 996_410, 996_412, 1_000_012].map((at) => {
    read = at;
    return now();
  });
  expect(heard).toEqual([1_000_010, 1_000_010, 1_000_012, 1_003_612]);
});
