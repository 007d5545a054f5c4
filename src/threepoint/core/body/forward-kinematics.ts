import { type MutablePose, makePose, type Pose } from '../math/pose';
import { copyQuat, multiply, rotate } from '../math/quat';
import { add, copyVec3 } from '../math/vec3';
import { recordOf } from '../records';
import type { UpperBodyPose } from './avatar-pose';
import { type JointName, jointNames, parentOf } from './joints';
import type { Skeleton } from './skeleton';

/** The pose of every joint, floor frame [m]. */
export type JointPoses = Readonly<Record<JointName, Pose<'floor'>>>;
export type MutableJointPoses = Readonly<Record<JointName, MutablePose<'floor'>>>;

export const createJointPoses = (): MutableJointPoses => recordOf(jointNames, () => makePose<'floor'>());

/**
 * Returns the pose of every joint, floor frame [m]: the skeleton's offsets rotated by the pose, parents first. `target`
 * is overwritten and returned.
 *
 * @example
 * const joints = forwardKinematics(skeletonFromCalibration(body.calibration), pose.body);
 * const elbow = joints.leftLowerArm.position;
 */
export function forwardKinematics(
  skeleton: Skeleton,
  pose: UpperBodyPose,
  target: MutableJointPoses = createJointPoses(),
): MutableJointPoses {
  for (let index = 0; index < jointNames.length; index++) {
    const joint = jointNames[index]!;
    const parent = parentOf[joint];
    const { position, orientation } = target[joint];
    if (parent === null) {
      copyVec3(pose.hipsPosition, position);
      copyQuat(pose.localRotations[joint], orientation);
    } else {
      const from = target[parent];
      add(from.position, rotate(from.orientation, skeleton.restOffsets[joint], position), position);
      multiply(from.orientation, pose.localRotations[joint], orientation);
    }
  }
  return target;
}
