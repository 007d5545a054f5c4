import fc from 'fast-check';
import { angleBetween, fromAxisAngle, multiply, type Quat, twistAngle, up, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { followBodyHeading, makeBodyHeading } from '../../../../src/threepoint/core/estimation/body-heading';
import { readHeading } from '../../../../src/threepoint/core/tracking/heading';
import { number, rotation, seed } from '../arbitraries';
import { fromEulerYxz } from '../euler-angles';

const turned = (yaw: number): Quat => fromAxisAngle(up, yaw);
const yawOf = (q: Quat): number => twistAngle(q, up);

/** The body's yaw after the head did what `at` says for so long. */
function yawAfter(seconds: number, at: (time: number) => Quat, rateHz = 60): number {
  const heading = makeBodyHeading();
  let yaw = yawOf(followBodyHeading(heading, readHeading(at(0)), 0));
  for (let i = 1; i <= Math.round(seconds * rateHz); i++)
    yaw = yawOf(followBodyHeading(heading, readHeading(at(i / rateHz)), 1 / rateHz));
  return yaw;
}

describe('a body under a head', () => {
  test('faces where the head does at first', () => {
    expect(yawAfter(0, () => turned(2))).toBeCloseTo(2, 9);
  });

  test('stays while the head glances aside', () => {
    expect(yawAfter(0.2, (time) => turned(time > 0 ? 0.6 : 0))).toBeLessThan(0.15);
  });

  test('comes along when the head turns further than a neck does', () => {
    expect(yawAfter(0.5, (time) => turned(Math.min(5 * time, 1.5)))).toBeGreaterThan(0.7);
  });

  test('ends up where the head keeps looking', () => {
    expect(yawAfter(6, (time) => turned(time > 0 ? 0.6 : 0))).toBeCloseTo(0.6, 1);
  });

  test('does not turn about when the head on its side changes its mind', () => {
    const tilted = (yaw: number) => multiply(turned(yaw), fromEulerYxz(vec3(0, 0, 1.45)));
    expect(yawAfter(1, (time) => (time === 0 ? turned(0) : tilted(Math.round(time * 60) % 2 ? 3 : -3)))).toBeCloseTo(
      0,
      9,
    );
  });

  test('never turns faster than a pirouette, however the head turns', () => {
    fc.assert(
      fc.property(fc.array(rotation, { minLength: 2, maxLength: 20 }), number(0.001, 0.1), (heads, step) => {
        const heading = makeBodyHeading();
        let before = followBodyHeading(heading, readHeading(heads[0]!), 0);
        for (const head of heads) {
          const now = followBodyHeading(heading, readHeading(head), step);
          expect(angleBetween(before, now)).toBeLessThan(14.001 * step);
          before = now;
        }
      }),
      { seed },
    );
  });

  test('does the same at 60, 72 and 120 Hz', () => {
    const looking = (time: number) => turned(1.4 * Math.sin(3 * time));
    for (const rate of [72, 120]) expect(yawAfter(1.5, looking, rate)).toBeCloseTo(yawAfter(1.5, looking, 60), 1);
  });

  test('forgotten, it faces where the head does again', () => {
    const heading = makeBodyHeading();
    followBodyHeading(heading, readHeading(turned(0)), 0);
    heading.yaw = Number.NaN;
    expect(yawOf(followBodyHeading(heading, readHeading(turned(-2)), 1 / 60))).toBeCloseTo(-2, 9);
  });
});
