import { describe, expect, test } from 'vitest';
import { type EstimatedJoint, estimatedJoints } from '../../../../src/threepoint/core/body/joints';
import { mapJoints } from '../../../../src/threepoint/core/estimation/joint-positions';
import { distance } from '../../../../src/threepoint/core/math/vec3';
import { completedFrame, fitted as fitBody } from './drawn';
import { type GoldenFit, quat, readGolden, vec } from './golden';

/** How far each joint is from where its twin puts it [m]. */
type Apart = Readonly<Record<EstimatedJoint, number>>;

const bodies = readGolden<GoldenFit[]>('fitted-joints.json');

function distancesFromTwin({ calibration, frames }: GoldenFit): readonly Apart[] {
  return frames.map(({ positions, rotations, estimated, fitted }) => {
    const pose = (index: number) => ({
      position: vec(positions[index] ?? []),
      orientation: quat(rotations[index] ?? []),
    });
    const joints = mapJoints((_, index) => vec(estimated[index] ?? []));
    const seen = completedFrame({ head: pose(0), leftHand: pose(1), rightHand: pose(2) }, calibration);
    const body = fitBody(calibration)(seen, joints, 0);
    const off = (joint: EstimatedJoint, index: number): number =>
      distance(body[joint].position, vec(fitted[index] ?? []));
    return mapJoints(off);
  });
}

// The loss of the network's training has torso and arm fitting in Python
// (training/threepoint_training/differentiable_kinematics.py).
describe.each(bodies)('torso and arms are fitted as in Python, eyes at $calibration.eyeHeight m', (body) => {
  const apart = distancesFromTwin(body);

  test.each([...new Set(body.frames.map(({ situation }) => situation))])('%s', (situation) => {
    body.frames.forEach((frame, index) => {
      if (frame.situation !== situation) return;
      for (const joint of estimatedJoints) {
        expect(apart[index]?.[joint], `${joint} in frame ${index}`).toBeLessThan(1e-6);
      }
    });
  });
});

test('elbows of both arms are kept out of the trunk in some of these frames', () => {
  const limited = bodies.flatMap(({ frames }) => frames.map((frame) => frame.limited));
  for (const arm of [0, 1]) expect(limited.filter((elbows) => elbows[arm]).length).toBeGreaterThan(3);
});
