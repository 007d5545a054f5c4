import fc from 'fast-check';
import { headingOf } from 'threepoint/core';
import { distance, forward, fromAxisAngle, multiply, right, rotate, transformPoint, up, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { floorFromHeading, headingFromFloor } from '../../../../src/threepoint/core/tracking/heading';
import { evenly, rotation, seed, vector } from '../arbitraries';
import { fromEulerYxz } from '../euler-angles';

describe('the heading', () => {
  test('is the yaw of the head, however it nods or tilts a little', () => {
    fc.assert(
      fc.property(evenly(-3, 3), evenly(-1.5, 1.5), evenly(-0.01, 0.01), (yaw, pitch, roll) => {
        expect(headingOf(fromEulerYxz(vec3(pitch, yaw, roll)))).toBeSameRotationAs(fromAxisAngle(up, yaw), 1);
      }),
      { seed },
    );
  });

  test('does not turn round when a person looks up past the zenith', () => {
    for (const pitch of [1.4, 1.55, 1.6, 1.75]) {
      expect(headingOf(fromEulerYxz(vec3(pitch, 0.5, 0)))).toBeSameRotationAs(fromAxisAngle(up, 0.5), 1e-4);
    }
  });

  test('a head on its side faces where it gazes', () => {
    const onItsSide = multiply(fromAxisAngle(up, 1), fromAxisAngle(forward, Math.PI / 2));
    expect(headingOf(onItsSide)).toBeSameRotationAs(fromAxisAngle(up, 1), 1e-4);
  });

  test('puts the head above the origin, facing −Z', () => {
    fc.assert(
      fc.property(vector(3), rotation, (position, orientation) => {
        const head = { position, orientation };
        const above = transformPoint(headingFromFloor(head), position);
        expect(distance(above, vec3(0, position.y, 0))).toBeLessThan(1e-9);
        const ahead = rotate(headingOf(orientation), forward);
        expect(Math.abs(ahead.y)).toBeLessThan(1e-12);
        expect(distance(transformPoint(floorFromHeading(head), above), position)).toBeLessThan(1e-9);
      }),
      { seed },
    );
  });

  test('keeps right on the right', () => {
    const orientation = fromEulerYxz(vec3(0.4, 2, 0.2));
    expect(rotate(headingOf(orientation), right).x * rotate(orientation, right).x).toBeGreaterThan(0);
  });
});
