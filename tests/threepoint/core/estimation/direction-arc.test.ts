import fc from 'fast-check';
import { distance, dot, length, normalise, rotate, scale, type Vec3, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { alongArc, directionArc } from '../../../../src/threepoint/core/estimation/arms/direction-arc';
import { evenly, seed } from '../arbitraries';

const direction = fc
  .record({ x: evenly(-1, 1), y: evenly(-1, 1), z: evenly(-1, 1) })
  .filter((v) => length(v) > 0.1)
  .map((v) => normalise(v as Vec3));
const outside = normalise(vec3(1, -0.2, -1));

const angle = (a: Vec3, b: Vec3): number => 2 * Math.asin(Math.min(1, distance(a, b) / 2));
/** The direction after this share of the way. */
const at = (from: Vec3, to: Vec3, share: number): Vec3 =>
  rotate(alongArc(directionArc(from, to, outside), share), from);
/** By how much each twentieth of the way turns [rad]. */
const steps = (from: Vec3, to: Vec3): number[] =>
  Array.from({ length: 20 }, (_, i) => angle(at(from, to, (i + 1) / 20), at(from, to, i / 20)));

describe('an arc from one direction to another', () => {
  test('starts at the first and ends at the second', () => {
    fc.assert(
      fc.property(direction, direction, (from, to) => {
        expect(distance(at(from, to, 0), from)).toBeLessThan(1e-9);
        expect(distance(at(from, to, 1), to)).toBeLessThan(1e-6);
      }),
      { seed },
    );
  });

  test('is gone along evenly: equal shares turn equal angles', () => {
    fc.assert(
      fc.property(direction, direction, (from, to) => {
        const turned = steps(from, to);
        const even = Math.max(...turned);
        // The bend halfway, of 60° at most, may be cut by one step.
        expect(turned.filter((step) => step < even - 1e-6).length).toBeLessThanOrEqual(1);
        expect(Math.min(...turned)).toBeGreaterThan(0.86 * even);
      }),
      { seed },
    );
  });

  test('is the shortest between directions less than 120° apart', () => {
    fc.assert(
      fc.property(direction, direction, (from, to) => {
        fc.pre(angle(from, to) < 2.09);
        const middle = at(from, to, 0.5);
        expect(angle(from, middle) + angle(middle, to)).toBeCloseTo(angle(from, to), 6);
        expect(Math.abs(angle(middle, from) - angle(middle, to))).toBeLessThan(1e-6);
      }),
      { seed },
    );
  });

  test('passes on the outside between opposite directions, and is at most a full turn', () => {
    fc.assert(
      fc.property(direction, (from) => {
        fc.pre(Math.abs(dot(from, outside)) < 0.9);
        const to = scale(from, -1);
        expect(dot(at(from, to, 0.5), outside)).toBeGreaterThan(0);
        expect(steps(from, to).reduce((sum, step) => sum + step)).toBeLessThan(2 * Math.PI);
      }),
      { seed },
    );
  });
});
