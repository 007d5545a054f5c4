import fc from 'fast-check';
import { clamp, damp, dampVec3, distance, smoothingFactor, smoothstep, up, vec3, zero } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { number, seed } from '../arbitraries';

describe('the damper', () => {
  test('goes half the way in a half-life', () => {
    expect(damp(1, 3, 0.2, 0.2)).toBeCloseTo(2, 12);
    expect(dampVec3(zero, vec3(4, 2, -2), 0.1, 0.2)).toEqual(vec3(3, 1.5, -1.5));
  });

  test('arrives at the same place at any frame rate', () => {
    fc.assert(
      fc.property(number(0.01, 1), number(0.01, 2), fc.integer({ min: 1, max: 50 }), (halfLife, seconds, steps) => {
        let value = 1;
        for (let i = 0; i < steps; i++) value = damp(value, 5, halfLife, seconds / steps);
        expect(value).toBeCloseTo(damp(1, 5, halfLife, seconds), 9);
      }),
      { seed },
    );
  });

  test('no time, no way; no half-life, at once', () => {
    expect(smoothingFactor(0.1, 0)).toBe(0);
    expect(smoothingFactor(0.1, -1)).toBe(0);
    expect(smoothingFactor(0, 0.01)).toBe(1);
    expect(distance(dampVec3(zero, up, 0, 0.001), up)).toBe(0);
  });
});

describe('smoothstep and clamp', () => {
  test('smoothstep starts at 0, ends at 1 and never falls', () => {
    fc.assert(
      fc.property(number(-1, 2), number(-1, 2), (a, b) => {
        const [low, high] = [Math.min(a, b), Math.max(a, b)];
        expect(smoothstep(0, 1, low)).toBeLessThanOrEqual(smoothstep(0, 1, high));
        expect(smoothstep(0, 1, Math.min(0, low))).toBe(0);
        expect(smoothstep(0, 1, 1 + Math.abs(high))).toBe(1);
      }),
      { seed },
    );
  });

  test('clamp holds a value between its ends', () => {
    expect([clamp(-1, 0, 2), clamp(1, 0, 2), clamp(3, 0, 2)]).toEqual([0, 1, 2]);
  });
});
