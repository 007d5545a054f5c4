import fc from 'fast-check';
import { expect, test } from 'vitest';
import type { Calibration } from '../../../src/core/body/calibration';
import { forwardKinematics } from '../../../src/core/body/forward-kinematics';
import type { JointName } from '../../../src/core/body/joints';
import { skeletonFromCalibration } from '../../../src/core/body/skeleton';
import { createEstimator } from '../../../src/core/estimation/estimators';
import { addScaled, distance, type Vec3, vec3 } from '../../../src/core/math/vec3';
import { evenly, seed } from '../arbitraries';
import { type Joints, poseOf } from './drawn';
import { standing, withHand } from './moving-person';

const calibration: Calibration = { eyeHeight: 1.62, armSpan: 1.53 };
const skeleton = skeletonFromCalibration(calibration);
const hip = vec3(-0.22, 0.85, -0.05);

/** The trunk of a person who stands still, with the right hand there in each frame at 60 Hz (null: not seen). */
function bodies(hands: readonly (Vec3 | null)[]): Joints[] {
  const estimator = createEstimator('ik', calibration);
  return hands.map((hand, i) => {
    const frame = standing(calibration, hip, hand ?? hip, i / 60);
    const { body } = poseOf(estimator, hand ? frame : withHand(frame, 'right', null));
    return forwardKinematics(skeleton, body!);
  });
}

const trunkAndShoulders = ['hips', 'chest', 'neck', 'leftUpperArm', 'rightUpperArm'] as const;

test('after a hand that comes back out of the arm’s reach no joint of the trunk steps 3 cm further than with the hand seen', () => {
  const reach = fc.record({ yaw: evenly(-0.8, 1.2), pitch: evenly(-0.6, 0.9), far: evenly(0.5, 0.68) });
  const sway = fc.record({ far: evenly(0.005, 0.03), rate: evenly(6, 15) });
  fc.assert(
    fc.property(reach, sway, evenly(0.15, 1.2), ({ yaw, pitch, far }, { far: swaying, rate }, lostFor) => {
      const there = vec3(Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), -Math.cos(yaw) * Math.cos(pitch));
      const hands = Array.from({ length: 150 }, (_, i) =>
        addScaled(vec3(0.17, 1.38, 0.05), there, far + swaying * Math.sin((rate * i) / 60)),
      );
      const lossy = bodies(hands.map((hand, i) => (i >= 30 && i < 30 + 60 * lostFor ? null : hand)));
      const whole = bodies(hands);
      const step = (body: Joints[], i: number, joint: JointName): number =>
        distance(body[i]![joint].position, body[i - 1]![joint].position);
      for (let i = 1; i < hands.length; i++) {
        for (const joint of trunkAndShoulders) {
          // Beyond what a clavicle can reach the trunk is unsteady after a hand that is seen all along, too.
          fc.pre(step(whole, i, joint) < 0.02);
          const excess = step(lossy, i, joint) - step(whole, i, joint);
          expect(excess, `${joint} at ${(i / 60).toFixed(2)} s`).toBeLessThan(0.03);
        }
      }
    }),
    { seed, numRuns: 40, endOnFailure: true },
  );
});
