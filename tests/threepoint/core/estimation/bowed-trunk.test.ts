import fc from 'fast-check';
import { chestSpaceBody } from 'threepoint/core';
import { distance, identity, quat, vec3 } from 'threepoint/math';
import { expect, test } from 'vitest';
import { solveIk } from '../../../../src/threepoint/core/estimation/ik/solve-ik';
import { copyJoints } from '../../../../src/threepoint/core/estimation/joint-positions';
import { evenly, seed } from '../arbitraries';
import { fromEulerYxz } from '../euler-angles';
import { calibration } from './posed-body';

const hipHeight = 0.9;
const hipsToHead = 0.72;
/** The bow goes past the horizontal: 110°. */
const [deepest, steps] = [1.9, 100];

/**
 * A hand that stays where it is while the person bows, on its own side: at the thigh, behind the back or on the floor.
 */
const hand = fc.record({ x: evenly(0.1, 0.5), y: evenly(0.1, 1.1), z: evenly(-0.3, 0.5) });

test('a trunk that bows past the horizontal turns over no shoulder, wherever the hands are', () => {
  const body = chestSpaceBody(calibration);
  fc.assert(
    fc.property(hand, hand, evenly(-0.3, 0.3), (left, right, roll) => {
      const bowedBy = (angle: number) =>
        copyJoints(
          solveIk(
            {
              head: {
                position: vec3(0, hipHeight + hipsToHead * Math.cos(angle), -hipsToHead * Math.sin(angle)),
                orientation: fromEulerYxz(vec3(-angle, 0, roll)),
              },
              leftHand: { position: vec3(-left.x, left.y, left.z), orientation: quat(0, 0, 0, 1) },
              rightHand: { position: vec3(right.x, right.y, right.z), orientation: quat(0, 0, 0, 1) },
            },
            () => identity,
            body,
          ).joints,
        );
      let before = bowedBy(0);
      for (let step = 1; step <= steps; step++) {
        const joints = bowedBy((deepest * step) / steps);
        for (const shoulder of ['leftUpperArm', 'rightUpperArm'] as const) {
          expect(distance(joints[shoulder], before[shoulder])).toBeLessThan(0.05);
        }
        before = joints;
      }
    }),
    { seed, numRuns: 50 },
  );
});
