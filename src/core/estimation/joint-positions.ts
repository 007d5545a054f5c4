import { type EstimatedJoint, estimatedJoints } from '../body/joints';
import { type Frame, type Transform, transformPoint } from '../math/pose';
import type { Vec3 } from '../math/vec3';

/** Where the six joints nobody tracks are [m], in the frame the variable's name says. */
export type JointPositions = Readonly<Record<EstimatedJoint, Vec3>>;

export function transformJoints<To extends Frame, From extends Frame>(
  toFromFrom: Transform<To, From>,
  joints: JointPositions,
): JointPositions {
  return mapJoints((joint) => transformPoint(toFromFrom, joints[joint]));
}

/** Builds positions joint by joint; `index` is the joint's place in every tensor. */
export function mapJoints(position: (joint: EstimatedJoint, index: number) => Vec3): JointPositions {
  const result = {} as Record<EstimatedJoint, Vec3>;
  for (let index = 0; index < estimatedJoints.length; index++) {
    const joint = estimatedJoints[index]!;
    result[joint] = position(joint, index);
  }
  return result;
}
