import type { JointPoses } from '../../../../src/threepoint/core/body/forward-kinematics';
import { jointNames, parentOf } from '../../../../src/threepoint/core/body/joints';
import type { Skeleton } from '../../../../src/threepoint/core/body/skeleton';
import { distance, length } from '../../../../src/threepoint/core/math/vec3';

/** Returns by how much [m] a bone of these joints is longer or shorter than in the skeleton, at most. */
export const boneStretch = (joints: JointPoses, { restOffsets }: Skeleton): number =>
  Math.max(
    ...jointNames.map((joint) => {
      const parent = parentOf[joint];
      const drawn = parent && distance(joints[joint].position, joints[parent].position);
      return drawn === null ? 0 : Math.abs(drawn - length(restOffsets[joint]));
    }),
  );
