import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import {
  composeTransforms,
  invertTransform,
  type Pose,
  type Transform,
  transformPoint,
  transformPose,
} from '../../../../src/threepoint/core/math/pose';
import { fromAxisAngle } from '../../../../src/threepoint/core/math/quat';
import { distance, up, vec3 } from '../../../../src/threepoint/core/math/vec3';
import { rotation, seed, vector } from '../arbitraries';

const transform = fc.record({ position: vector(5), orientation: rotation });

describe('transforms', () => {
  test('a hand ahead of a person who faces left is on the left of the floor', () => {
    const floorFromHeading: Transform<'floor', 'heading'> = {
      position: vec3(2, 0, 1),
      orientation: fromAxisAngle(up, Math.PI / 2),
    };
    const hand = transformPoint(floorFromHeading, vec3(0, 1.2, -0.5));
    expect(distance(hand, vec3(1.5, 1.2, 1))).toBeLessThan(1e-12);
  });

  test('the inverse takes everything back', () => {
    fc.assert(
      fc.property(transform, transform, (t, pose) => {
        const arenaFromFloor: Transform<'arena', 'floor'> = t;
        const there = transformPose(arenaFromFloor, pose as Pose<'floor'>);
        const back = transformPose(invertTransform(arenaFromFloor), there);
        expect(distance(back.position, pose.position)).toBeLessThan(1e-9);
        expect(back.orientation).toBeSameRotationAs(pose.orientation);
      }),
      { seed },
    );
  });

  test('composing is transforming twice', () => {
    fc.assert(
      fc.property(transform, transform, vector(5), (a, b, point) => {
        const arenaFromFloor: Transform<'arena', 'floor'> = a;
        const floorFromHeading: Transform<'floor', 'heading'> = b;
        const once = transformPoint(composeTransforms(arenaFromFloor, floorFromHeading), point);
        const twice = transformPoint(arenaFromFloor, transformPoint(floorFromHeading, point));
        expect(distance(once, twice)).toBeLessThan(1e-9);
      }),
      { seed },
    );
  });
});
