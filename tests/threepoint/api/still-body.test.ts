import fc from 'fast-check';
import { Body } from 'threepoint/api/body';
import { copyAvatarPose } from 'threepoint/core/body/avatar-pose';
import { forwardKinematics } from 'threepoint/core/body/forward-kinematics';
import { jointNames } from 'threepoint/core/body/joints';
import { skeletonFromCalibration } from 'threepoint/core/body/skeleton';
import type { TrackedPose } from 'threepoint/core/math/pose';
import { identity } from 'threepoint/core/math/quat';
import { distance, type Vec3, vec3 } from 'threepoint/core/math/vec3';
import { expect, test } from 'vitest';
import { evenly, seed } from '../core/arbitraries';
import { openPlainModel } from '../core/estimation/shipped-models';

const calibration = { eyeHeight: 1.6, armSpan: 1.51 };
const skeleton = skeletonFromCalibration(calibration);
const tracked = (position: Vec3): TrackedPose => ({ position, orientation: identity, tracking: 'tracked' });
const rate = 1 / 72;

test('a body whose hands meet or cross in front and hold still moves by no more than 0.1 mm a frame after two seconds', () => {
  const hands = fc.record({ x: evenly(-0.3, 0.2), y: evenly(0.75, 1.35), ahead: evenly(0.15, 0.45) });
  return fc.assert(
    fc.asyncProperty(hands, fc.constantFrom('ik' as const, 'learned' as const), async ({ x, y, ahead }, estimator) => {
      const body = new Body({ calibration, estimator, networks: async () => openPlainModel() });
      await body.setEstimator(estimator);
      const joints = (row: number) => {
        const pose = body.update({
          time: row * rate,
          head: tracked(vec3(0, 1.6, 0)),
          leftHand: tracked(vec3(-x, y, -ahead)),
          rightHand: tracked(vec3(x, y, -ahead)),
        });
        return forwardKinematics(skeleton, copyAvatarPose(pose!).body!);
      };
      for (let row = 0; row < 144; row++) joints(row);
      let before = joints(144);
      for (let row = 145; row < 170; row++) {
        const now = joints(row);
        for (const joint of jointNames)
          expect(distance(now[joint].position, before[joint].position)).toBeLessThan(1e-4);
        before = now;
      }
      await body.dispose();
    }),
    { seed, numRuns: 30 },
  );
});
