import { describe, expect, test } from 'vitest';
import { FramePacer, reflectionSize } from '../../../src/threepoint/avatar/mirror';

/** Height to width of the page's mirror. */
const standing = 2.15 / 1.5;

describe('the reflection of a mirror', () => {
  test.each([
    ['Quest 2', 1440 * 1584],
    ['Quest 3', 1680 * 1760],
    ['a small emulated eye', 480 * 270],
  ])('has at most half an eye of %s in pixels, and its share at 1.5 m', (_, pixels) => {
    const { width, height } = reflectionSize(pixels, standing, 1024);
    expect(width * height).toBeLessThanOrEqual(pixels / 2);
    // The mirror fills 0.29 of an eye of 96° there.
    expect(width * height).toBeGreaterThan(0.29 * pixels);
    expect(height / width).toBeCloseTo(standing, 1);
  });

  test('is no wider than it was asked to be, however large the eye is', () => {
    for (const pixels of [4000 * 4000, Number.POSITIVE_INFINITY])
      expect(reflectionSize(pixels, standing, 1024)).toEqual({ width: 1024, height: 1467 });
  });
});

describe('the pace of reflections', () => {
  /** Returns how many frames of ten seconds at a rate are due, and the longest wait between two of them [s]. */
  function tenSeconds(pace: FramePacer, frameHz: number): { readonly due: number; readonly longest: number } {
    let due = 0;
    let last = 0;
    let longest = 0;
    for (let i = 0; i < 10 * frameHz; i++) {
      // A device's frames come a little early and late.
      const time = i / frameHz + 0.0004 * Math.sin(7 * i);
      if (!pace.isDue(time)) continue;
      due += 1;
      longest = Math.max(longest, time - last);
      last = time;
    }
    return { due, longest };
  }

  test.each([72, 80, 90, 120])('is 36 a second in frames of %i Hz', (frameHz) => {
    const pace = new FramePacer();
    pace.rateHz = 36;
    const { due, longest } = tenSeconds(pace, frameHz);
    expect(due).toBeGreaterThanOrEqual(355);
    expect(due).toBeLessThanOrEqual(361);
    expect(longest).toBeLessThan(1 / 36 + 1 / frameHz + 0.001);
  });

  test('is that of the frames where they are slower, or where it has no bound', () => {
    const pace = new FramePacer();
    expect(tenSeconds(pace, 72).due).toBe(720);
    pace.rateHz = 36;
    expect(tenSeconds(pace, 30).due).toBe(300);
  });

  test('starts at once after a pause, a restart and a clock that was set back', () => {
    const pace = new FramePacer();
    pace.rateHz = 36;
    expect(pace.isDue(100)).toBe(true);
    expect(pace.isDue(100.01)).toBe(false);
    expect(pace.isDue(160)).toBe(true);
    expect(pace.isDue(160.01)).toBe(false);
    expect(pace.isDue(3)).toBe(true);
    pace.restart();
    expect(pace.isDue(3.01)).toBe(true);
  });
});
