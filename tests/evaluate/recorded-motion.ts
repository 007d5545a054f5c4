import { type Calibration, createEstimator, forwardKinematics, skeletonFromCalibration } from 'threepoint/core';
import type { Vec3 } from 'threepoint/math';
import { type RecordedFrame, type TruthJoint, truthJoints } from '../../bench/evaluate/recordings';
import { poseOf } from '../threepoint/core/estimation/drawn';
import { movingPerson } from '../threepoint/core/estimation/moving-person';

export const person: Calibration = { eyeHeight: 1.6, armSpan: 1.5 };

/**
 * Returns generated motion at 60 Hz with a truth that a body could have: where IK for another body of nearly this size
 * puts the joints.
 */
export function recordedMotion(seed: number, frames: number): RecordedFrame[] {
  const other: Calibration = { eyeHeight: person.eyeHeight * 0.98, armSpan: person.armSpan * 1.03 };
  const at = movingPerson(seed, person, { x: 0.3, z: -0.2, yaw: 2 });
  const ik = createEstimator('ik', other);
  const skeleton = skeletonFromCalibration(other);
  return Array.from({ length: frames }, (_, row) => {
    const frame = at(row / 60);
    const { body } = poseOf(ik, frame);
    if (!body) throw new Error('IK drew no body');
    const joints = forwardKinematics(skeleton, body);
    const truth = Object.fromEntries(truthJoints.map((joint) => [joint, joints[joint].position]));
    return { frame, truth: truth as Record<TruthJoint, Vec3> };
  });
}
