import { type JointPoses, jointNames, type Skeleton } from 'threepoint/core';
import { distance, length } from 'threepoint/math';
import { parentOf } from '../../../../src/threepoint/core/body/joints';

/** Returns by how much [m] a bone of these joints is longer or shorter than in the skeleton, at most. */
export const boneStretch = (joints: JointPoses, { restOffsets }: Skeleton): number =>
  Math.max(
    ...jointNames.map((joint) => {
      const parent = parentOf[joint];
      const drawn = parent && distance(joints[joint].position, joints[parent].position);
      return drawn === null ? 0 : Math.abs(drawn - length(restOffsets[joint]));
    }),
  );
