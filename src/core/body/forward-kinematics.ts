import type { Pose } from '../math/pose';
import { multiply, rotate } from '../math/quat';
import { add } from '../math/vec3';
import type { UpperBodyPose } from './avatar-pose';
import { type JointName, jointNames, parentOf } from './joints';
import type { Skeleton } from './skeleton';

/** Where every joint is, floor frame: the skeleton's offsets turned by the pose's rotations, parents first. */
export function forwardKinematics(skeleton: Skeleton, pose: UpperBodyPose): Record<JointName, Pose<'floor'>> {
  const joints = {} as Record<JointName, Pose<'floor'>>;
  for (const joint of jointNames) {
    const parent = parentOf[joint];
    const rotation = pose.localRotations[joint];
    if (parent === null) {
      joints[joint] = { position: pose.hipsPosition, orientation: rotation };
    } else {
      const { position, orientation } = joints[parent];
      joints[joint] = {
        position: add(position, rotate(orientation, skeleton.restOffsets[joint])),
        orientation: multiply(orientation, rotation),
      };
    }
  }
  return joints;
}
