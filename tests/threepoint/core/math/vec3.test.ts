import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import {
  add,
  cross,
  distance,
  dot,
  forward,
  length,
  lerp,
  normalise,
  reject,
  right,
  scale,
  subtract,
  up,
  vec3,
  zero,
} from '../../../../src/threepoint/core/math/vec3';
import { direction, number, seed, vector } from '../arbitraries';

describe('vectors', () => {
  test('right, up and backward make a right-handed frame', () => {
    expect(distance(cross(right, up), scale(forward, -1))).toBe(0);
  });

  test('the cross product is at right angles to both factors and as long as their parallelogram', () => {
    fc.assert(
      fc.property(vector(10), vector(10), (a, b) => {
        const c = cross(a, b);
        expect(Math.abs(dot(c, a))).toBeLessThan(1e-9);
        expect(Math.abs(dot(c, b))).toBeLessThan(1e-9);
        expect(dot(c, c)).toBeCloseTo(dot(a, a) * dot(b, b) - dot(a, b) ** 2, 6);
      }),
      { seed },
    );
  });

  test('normalise keeps the direction and makes the length 1', () => {
    fc.assert(
      fc.property(vector(1e6), (v) => {
        fc.pre(length(v) > 1e-6);
        const n = normalise(v);
        expect(length(n)).toBeCloseTo(1, 12);
        expect(distance(scale(n, length(v)), v)).toBeLessThan(1e-9 * length(v));
      }),
      { seed },
    );
  });

  test('a vector without direction gets the stated fallback', () => {
    expect(normalise(zero)).toEqual(up);
    expect(normalise(vec3(1e-12, 0, 0), forward)).toEqual(forward);
  });

  test('reject leaves nothing along the axis and takes away nothing else', () => {
    fc.assert(
      fc.property(vector(10), direction, (v, axis) => {
        const across = reject(v, axis);
        expect(Math.abs(dot(across, axis))).toBeLessThan(1e-9);
        expect(length(cross(subtract(v, across), axis))).toBeLessThan(1e-9);
      }),
      { seed },
    );
  });

  test('lerp goes from one end to the other on the straight line', () => {
    fc.assert(
      fc.property(vector(10), vector(10), number(0, 1), (a, b, t) => {
        expect(distance(lerp(a, b, 0), a)).toBe(0);
        expect(distance(lerp(a, b, 1), b)).toBeLessThan(1e-12);
        expect(distance(a, lerp(a, b, t)) + distance(lerp(a, b, t), b)).toBeCloseTo(distance(a, b), 9);
        expect(distance(add(a, b), add(b, a))).toBe(0);
      }),
      { seed },
    );
  });
});
