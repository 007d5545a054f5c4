import fc from 'fast-check';
import {
  add,
  addScaled,
  composeTransforms,
  conjugate,
  copyQuat,
  copyVec3,
  cross,
  invertTransform,
  lerp,
  makePose,
  multiply,
  normalise,
  normaliseQuat,
  type Quat,
  reject,
  rotate,
  rotationBetween,
  scale,
  slerp,
  subtract,
  transformPoint,
  transformPose,
  twistOf,
  up,
  type Vec3,
} from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { alignDirections, limitAngle, restDirections, rotateInverse } from '../../../../src/threepoint/core/math/quat';
import { rotation, seed, vector } from '../arbitraries';

type OfVectors = (a: Vec3, b: Vec3, target?: Vec3) => Vec3;
type OfRotations = (a: Quat, b: Quat, target?: Quat) => Quat;

const ofVectors: Record<string, OfVectors> = {
  add,
  subtract,
  cross,
  reject,
  scale: (a, _, target) => scale(a, 1.7, target),
  addScaled: (a, b, target) => addScaled(a, b, -0.3, target),
  lerp: (a, b, target) => lerp(a, b, 0.3, target),
  normalise: (a, b, target) => normalise(a, b, target),
  'normalise, fallback': (_, b, target) => normalise({ x: 0, y: 0, z: 0 }, b, target),
};

const ofRotations: Record<string, OfRotations> = {
  multiply,
  conjugate: (a, _, target) => conjugate(a, target),
  normaliseQuat: (a, _, target) => normaliseQuat(a, target),
  slerp: (a, b, target) => slerp(a, b, 0.3, target),
  limitAngle: (a, _, target) => limitAngle(a, 0.4, target),
  twistOf: (a, _, target) => twistOf(a, up, target),
};

describe('a target holds the result, and may be one of the arguments', () => {
  test.each(Object.entries(ofVectors))('%s', (_, make) => {
    fc.assert(
      fc.property(vector(2), vector(2), (a, b) => {
        const expected = make(a, b);
        const first = copyVec3(a);
        expect(make(first, b, first)).toBe(first);
        expect(first).toEqual(expected);
        const second = copyVec3(b);
        expect(make(a, second, second)).toBe(second);
        expect(second).toEqual(expected);
      }),
      { seed },
    );
  });

  test.each(Object.entries(ofRotations))('%s', (_, make) => {
    fc.assert(
      fc.property(rotation, rotation, (a, b) => {
        const expected = make(a, b);
        const first = copyQuat(a);
        expect(make(first, b, first)).toBe(first);
        expect(first).toEqual(expected);
        const second = copyQuat(b);
        expect(make(a, second, second)).toBe(second);
        expect(second).toEqual(expected);
      }),
      { seed },
    );
  });

  test('vectors that are rotated, aligned or transformed', () => {
    fc.assert(
      fc.property(rotation, vector(2), vector(2), rotation, (q, a, b, other) => {
        const [turned, back] = [copyVec3(a), copyVec3(a)];
        expect(rotate(q, turned, turned)).toEqual(rotate(q, a));
        expect(rotateInverse(q, back, back)).toEqual(rotateInverse(q, a));
        const kept = copyQuat(q);
        expect(rotationBetween(a, b, kept)).toEqual(rotationBetween(a, b));
        const rest = restDirections(a, b);
        expect(alignDirections(rest, b, up, kept)).toEqual(alignDirections(rest, b, up));

        const t = { position: a, orientation: q };
        const pose = { position: b, orientation: other };
        const [point, moved, inverse, composed] = [copyVec3(b), makePose(), makePose(), makePose()];
        expect(transformPoint(t, point, point)).toEqual(transformPoint(t, b));
        expect(transformPose(t, pose, moved)).toEqual(transformPose(t, pose));
        expect(transformPose(t, moved, moved)).toEqual(transformPose(t, transformPose(t, pose)));
        expect(invertTransform(t, inverse)).toEqual(invertTransform(t));
        expect(composeTransforms(t, pose, composed)).toEqual(composeTransforms(t, pose));
      }),
      { seed },
    );
  });
});
