import fc from 'fast-check';
import {
  add,
  angleBetween,
  conjugate,
  cross,
  distance,
  dot,
  fromAxes,
  fromAxisAngle,
  identity,
  length,
  multiply,
  normaliseQuat,
  type Quat,
  right,
  rotate,
  rotationBetween,
  scale,
  slerp,
  twistAngle,
  twistOf,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { alignDirections, limitAngle, restDirections, toEulerYxz } from '../../../../src/threepoint/core/math/quat';
import { direction, number, rotation, seed, vector } from '../arbitraries';
import { fromEulerYxz } from '../euler-angles';

/** v rotated about a unit axis by Rodrigues' formula: an oracle that knows no quaternions. */
function rodrigues(axis: Vec3, angle: number, v: Vec3): Vec3 {
  const c = Math.cos(angle);
  return add(add(scale(v, c), scale(cross(axis, v), Math.sin(angle))), scale(axis, dot(axis, v) * (1 - c)));
}

const negated = (q: Quat): Quat => ({ x: -q.x, y: -q.y, z: -q.z, w: -q.w });

describe('rotations', () => {
  test('a quarter turn about up takes right to forward', () => {
    expect(distance(rotate(fromAxisAngle(up, Math.PI / 2), right), vec3(0, 0, -1))).toBeLessThan(1e-15);
  });

  test('rotate agrees with Rodrigues', () => {
    fc.assert(
      fc.property(direction, number(-7, 7), vector(5), (axis, angle, v) => {
        expect(distance(rotate(fromAxisAngle(axis, angle), v), rodrigues(axis, angle, v))).toBeLessThan(1e-12);
      }),
      { seed },
    );
  });

  test('a product is one rotation after the other, and the conjugate undoes it', () => {
    fc.assert(
      fc.property(rotation, rotation, vector(5), (a, b, v) => {
        expect(distance(rotate(multiply(a, b), v), rotate(a, rotate(b, v)))).toBeLessThan(1e-12);
        expect(multiply(multiply(a, b), conjugate(b))).toBeSameRotationAs(a);
      }),
      { seed },
    );
  });

  test('the smallest rotation between two directions takes the one to the other, opposed ones included', () => {
    fc.assert(
      fc.property(direction, direction, (a, b) => {
        expect(distance(rotate(rotationBetween(a, b), a), b)).toBeLessThan(1e-7);
        expect(distance(rotate(rotationBetween(a, scale(a, -1)), a), scale(a, -1))).toBeLessThan(1e-7);
      }),
      { seed },
    );
  });

  test('fromAxes finds the rotation again from its axes, half turns included', () => {
    fc.assert(
      fc.property(rotation, (q) => {
        const axes = [right, up, vec3(0, 0, 1)].map((axis) => rotate(q, axis)) as [Vec3, Vec3, Vec3];
        expect(fromAxes(...axes)).toBeSameRotationAs(q, 1e-5);
      }),
      { seed },
    );
  });

  test('aligning puts the main direction exactly and the side as near as it can be', () => {
    fc.assert(
      fc.property(direction, direction, direction, direction, (fromMain, fromSide, toMain, toSide) => {
        const q = alignDirections(restDirections(fromMain, fromSide), toMain, toSide);
        expect(distance(rotate(q, fromMain), toMain)).toBeLessThan(1e-6);
        fc.pre(length(cross(fromMain, fromSide)) > 1e-3 && length(cross(toMain, toSide)) > 1e-3);
        // The turned side lies in the half-plane that main and wanted side span.
        const normal = cross(toMain, toSide);
        const turned = rotate(q, fromSide);
        expect(Math.abs(dot(turned, normal))).toBeLessThan(1e-6);
        expect(dot(cross(toMain, turned), normal)).toBeGreaterThan(0);
      }),
      { seed },
    );
  });

  test('slerp takes the shorter arc, evenly, with any signs', () => {
    fc.assert(
      fc.property(rotation, rotation, number(0, 1), (a, b, t) => {
        const angle = angleBetween(a, b);
        fc.pre(angle < Math.PI - 1e-3);
        expect(angleBetween(a, slerp(a, b, t))).toBeCloseTo(t * angle, 6);
        expect(slerp(a, negated(b), t)).toBeSameRotationAs(slerp(a, b, t), 1e-5);
        expect(slerp(a, b, 1)).toBeSameRotationAs(b, 1e-5);
      }),
      { seed },
    );
  });

  test('swing and twist recompose a rotation; the twist keeps the axis, the swing avoids it', () => {
    fc.assert(
      fc.property(rotation, direction, (q, axis) => {
        const twist = twistOf(q, axis);
        const swing = multiply(q, conjugate(twist));
        expect(multiply(swing, twist)).toBeSameRotationAs(q, 1e-5);
        expect(distance(rotate(twist, axis), axis)).toBeLessThan(1e-7);
        fc.pre(length(add(rotate(q, axis), axis)) > 1e-3);
        expect(Math.abs(swing.x * axis.x + swing.y * axis.y + swing.z * axis.z)).toBeLessThan(1e-7);
      }),
      { seed },
    );
  });

  test('the twist angle is the angle of a rotation about the axis, sign included', () => {
    fc.assert(
      fc.property(direction, number(-3.1, 3.1), (axis, angle) => {
        expect(twistAngle(fromAxisAngle(axis, angle), axis)).toBeCloseTo(angle, 9);
        expect(twistAngle(negated(fromAxisAngle(axis, angle)), axis)).toBeCloseTo(angle, 9);
      }),
      { seed },
    );
  });

  test('a limited rotation keeps its axis and never exceeds the limit', () => {
    fc.assert(
      fc.property(rotation, number(0.01, 3), (q, limit) => {
        const limited = limitAngle(q, limit);
        const angle = angleBetween(identity, q);
        expect(angleBetween(identity, limited)).toBeCloseTo(Math.min(limit, angle), 6);
        fc.pre(angle < Math.PI - 1e-3);
        expect(angleBetween(limited, q)).toBeCloseTo(Math.max(0, angle - limit), 6);
      }),
      { seed },
    );
  });

  test('Euler angles Y-X-Z give the rotation again, looking straight up and down included', () => {
    fc.assert(
      fc.property(rotation, (q) => {
        expect(fromEulerYxz(toEulerYxz(q))).toBeSameRotationAs(q, 1e-4);
      }),
      { seed },
    );
  });

  test('a quaternion without length is no rotation', () => {
    expect(normaliseQuat({ x: 0, y: 0, z: 0, w: 0 })).toEqual(identity);
  });
});

describe('toBeSameRotationAs', () => {
  const q = fromAxisAngle(up, 1);

  test('q and −q are the same', () => {
    expect(q).toBeSameRotationAs(negated(q));
  });

  test('one degree is distinguished from two', () => {
    const turned = fromAxisAngle(up, 1 + (1.5 * Math.PI) / 180);
    expect(turned).toBeSameRotationAs(q, 2);
    expect(turned).not.toBeSameRotationAs(q, 1);
  });

  test('NaN and what is not of length 1 are no rotation', () => {
    expect({ ...q, x: Number.NaN }).not.toBeSameRotationAs(q, 180);
    expect({ x: 0, y: 0, z: 0, w: 2 }).not.toBeSameRotationAs(identity, 180);
  });
});
