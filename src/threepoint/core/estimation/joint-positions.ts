import { type EstimatedJoint, estimatedJoints } from '../body/joints';
import { type Frame, type Transform, transformPoint } from '../math/pose';
import { copyVec3, type MutableVec3, type Vec3, vec3 } from '../math/vec3';
import { recordOf } from '../records';

/** The six joints that no device tracks [m], in the frame that the variable's name states. */
export type JointPositions = Readonly<Record<EstimatedJoint, Vec3>>;

/** Six joints that their owner overwrites. */
export type MutableJointPositions = Readonly<Record<EstimatedJoint, MutableVec3>>;

/** Builds a record joint by joint; `index` is the joint's place in every tensor. */
export const mapJoints = <T>(make: (joint: EstimatedJoint, index: number) => T): Record<EstimatedJoint, T> =>
  recordOf(estimatedJoints, make);

export const makeJoints = (): MutableJointPositions => mapJoints(() => vec3(0, 0, 0));

export function copyJoints(
  joints: JointPositions,
  target: MutableJointPositions = makeJoints(),
): MutableJointPositions {
  for (let index = 0; index < estimatedJoints.length; index++) {
    const joint = estimatedJoints[index]!;
    copyVec3(joints[joint], target[joint]);
  }
  return target;
}

export function transformJoints<To extends Frame, From extends Frame>(
  toFromFrom: Transform<To, From>,
  joints: JointPositions,
  target: MutableJointPositions = makeJoints(),
): MutableJointPositions {
  for (let index = 0; index < estimatedJoints.length; index++) {
    const joint = estimatedJoints[index]!;
    transformPoint(toFromFrom, joints[joint], target[joint]);
  }
  return target;
}
