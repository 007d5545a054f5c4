import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { createPageClock, maxStepSeconds, monotonic } from '../../../../src/threepoint/core/tracking/page-clock';

const frameMs = 1000 / 72;
/** The part of a pause that counts [s]. */
const pauseSeconds = 0.5;

/** Returns the times of these time stamps [ms], each passed when `read` returns `readOf` of it. */
function timesOf(
  stamps: readonly number[],
  readOf: (stamp: number, index: number) => number = (stamp) => stamp,
): readonly number[] {
  let read = readOf(stamps[0] ?? 0, 0);
  const clock = createPageClock(() => read);
  return stamps.map((stamp, index) => {
    read = readOf(stamp, index);
    return clock.tick(stamp);
  });
}

describe('the page’s clock', () => {
  test('advances with every frame, by two seconds at most, whatever the time stamps', () => {
    const steps = fc.oneof(
      { weight: 8, arbitrary: fc.double({ min: 5, max: 40, noNaN: true }) },
      fc.double({ min: -1e7, max: 1e7, noNaN: true }),
      fc.constant(0),
    );
    fc.assert(
      fc.property(fc.double({ min: 0, max: 1e9, noNaN: true }), fc.array(steps, { maxLength: 60 }), (start, by) => {
        const stamps = [start];
        for (const step of by) stamps.push((stamps.at(-1) ?? 0) + step);
        // Whatever the device says, a frame later is two seconds later at most.
        const times = timesOf(stamps, (_, index) => 1000 * maxStepSeconds * index);
        for (const [i, time] of times.entries()) {
          const passed = time - (times[i - 1] ?? time - 0.01);
          expect(passed).toBeGreaterThan(0);
          expect(passed).toBeLessThanOrEqual(maxStepSeconds + 1e-6);
        }
      }),
      { seed: 14 },
    );
  });

  test('with ordinary frames it is the device’s own, slow ones included', () => {
    const stamps = [1000, 1014, 1028, 1300, 1800, 1814];
    expect(timesOf(stamps)).toEqual(stamps.map((stamp) => expect.closeTo(stamp / 1000, 9)));
  });

  test.each([
    [200, 900, 300],
    [600, 600, 600],
    [1100, 500, 900],
  ])('passes as time does where frames take %d, %d and %d ms in turn', (...lengths) => {
    const stamps = [0];
    for (let i = 0; i < 90; i++) stamps.push((stamps.at(-1) ?? 0) + lengths[i % 3]!);
    const times = timesOf(stamps);
    const from = 10;
    const passed = times.at(-1)! - times[from]!;
    expect(passed).toBeCloseTo((stamps.at(-1)! - stamps[from]!) / 1000, 6);
    // Until it knows the machine, it takes a few frames for pauses.
    expect(times[from]! - times[0]!).toBeGreaterThan((0.5 * stamps[from]!) / 1000);
  });

  test('advances after a time stamp that is no finite number, even the first', () => {
    const stamps = [Number.NaN, 1014, 1028, Number.POSITIVE_INFINITY, 1056, Number.NaN, 1084];
    const read = (_: number, index: number) => 1000 + 14 * index;
    expect(timesOf(stamps, read)).toEqual(stamps.map((_, index) => expect.closeTo(1 + 0.014 * index, 9)));
  });

  test('one for two bodies has one time a frame, however late the second asks', () => {
    let read = 0;
    const clock = createPageClock(() => read);
    const stamps = Array.from({ length: 91 }, (_, frame) => 1000 + frame * frameMs);
    const times = stamps.map((stamp) => {
      read = stamp;
      const first = clock.tick(stamp);
      read = stamp + 0.4 * frameMs;
      expect(clock.now()).toBeGreaterThan(first);
      expect(clock.tick(stamp)).toBe(first);
      return first;
    });
    expect(times.at(-1)! - times[0]!).toBeCloseTo((90 * frameMs) / 1000, 6);
  });

  test('a pause is one for all who ask in its frame', () => {
    let read = 1000;
    const clock = createPageClock(() => read);
    clock.tick(1000);
    read = 9000;
    const heard = [0, 1, 2].map((later) => {
      read = 9000 + later;
      return [clock.tick(9000), clock.paused];
    });
    expect(heard).toEqual([0, 1, 2].map(() => [expect.closeTo(1.5, 9), true]));
    expect(clock.skippedSeconds).toBeCloseTo(7.5, 9);
  });

  test('a device that dates several frames alike has them as long as the last', () => {
    const times = timesOf([0, 16, 16, 16, 48], (_, index) => 16 * index);
    expect(times).toEqual([0, 0.016, 0.032, 0.048, 0.08].map((time) => expect.closeTo(time, 9)));
  });

  test('a step back and the correction are a frame and a pause', () => {
    const stamps = [50_000, 50_000 + frameMs, 45_000, 45_000 + frameMs, 50_000 + 4 * frameMs];
    const times = timesOf(stamps);
    const passed = times.slice(1).map((time, i) => time - (times[i] ?? 0));
    const frame = frameMs / 1000;
    expect(passed).toEqual([frame, frame, frame, pauseSeconds].map((seconds) => expect.closeTo(seconds, 6)));
  });

  test('time left out of a pause is reported, of a step back none', () => {
    let read = 0;
    const clock = createPageClock(() => read);
    for (const stamp of [0, 16, 20_016]) {
      read = stamp;
      clock.tick(stamp);
    }
    expect([clock.paused, clock.skippedSeconds]).toEqual([true, expect.closeTo(20 - pauseSeconds, 9)]);
    clock.tick(16);
    expect([clock.paused, clock.skippedSeconds]).toEqual([false, expect.closeTo(20 - pauseSeconds, 9)]);
  });

  test('advances between frames with the browser’s, within a frame’s length, and no frame precedes it', () => {
    let read = 5000;
    const clock = createPageClock(() => read);
    const first = clock.tick(4990);
    read = 5008;
    expect(clock.now()).toBeCloseTo(first + 0.008, 9);
    read = 65_000;
    expect(clock.now()).toBeCloseTo(first + pauseSeconds, 9);
    read = 100;
    expect(clock.now()).toBeCloseTo(first + pauseSeconds, 9);
    expect(clock.tick(64_990)).toBeGreaterThanOrEqual(first + pauseSeconds);
  });
});

test('the time of day of a study stays in order when the system’s is set back', () => {
  let read = 1_000_000;
  const now = monotonic(() => read);
  const heard = [1_000_010, 996_410, 996_412, 1_000_012].map((at) => {
    read = at;
    return now();
  });
  expect(heard).toEqual([1_000_010, 1_000_010, 1_000_012, 1_003_612]);
});
