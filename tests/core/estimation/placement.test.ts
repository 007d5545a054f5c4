import { describe, expect, test } from 'vitest';
import { forwardKinematics } from '../../../src/core/body/forward-kinematics';
import { type EstimatedJoint, estimatedJoints } from '../../../src/core/body/joints';
import { skeletonFromCalibration } from '../../../src/core/body/skeleton';
import { mapJoints } from '../../../src/core/estimation/joint-positions';
import { emptyMemory, reconstructOrientations } from '../../../src/core/estimation/reconstruct-orientations';
import { distance } from '../../../src/core/math/vec3';
import { type GoldenPlacement, quat, readGolden, vec } from './golden';

/** How far each joint is from where training has it [m]. */
type Off = Readonly<Record<EstimatedJoint, number>>;

// The loss of the network's training has the skeleton's placement in Python (training/threepoint_training/placement.py).
describe.each(readGolden<GoldenPlacement[]>('placement.json'))(
  'joints are placed as in training, eyes at $calibration.eyeHeight m',
  ({ calibration, frames }) => {
    const skeleton = skeletonFromCalibration(calibration);
    const apart = frames.map(({ positions, rotations, estimated, placed }) => {
      const pose = (index: number) => ({
        position: vec(positions[index] ?? []),
        orientation: quat(rotations[index] ?? []),
      });
      const joints = mapJoints((_, index) => vec(estimated[index] ?? []));
      const seen = { head: pose(0), leftHand: pose(1), rightHand: pose(2), joints };
      const body = forwardKinematics(skeleton, reconstructOrientations(seen, skeleton, emptyMemory(), 1 / 60));
      const off = (joint: EstimatedJoint, index: number): number =>
        distance(body[joint].position, vec(placed[index] ?? []));
      return Object.fromEntries(estimatedJoints.map((joint, index) => [joint, off(joint, index)])) as Off;
    });

    test.each(['leftUpperArm', 'rightUpperArm', 'chest', 'hips'] as const)('%s', (joint) => {
      for (const each of apart) expect(each[joint]).toBeLessThan(1e-3);
    });

    test('elbows, where the trunk is not in their way', () => {
      const elbows = apart.flatMap(({ leftLowerArm, rightLowerArm }) => [leftLowerArm, rightLowerArm]);
      expect(elbows.filter((each) => each < 2e-3).length).toBeGreaterThan(0.8 * elbows.length);
    });
  },
);
