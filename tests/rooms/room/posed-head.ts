import { defaultCalibration, skeletonFromCalibration, unknownFingers } from 'threepoint/core';
import { add, identity, type Vec3, vec3 } from 'threepoint/math';
import { encodePose } from '../../../src/rooms/protocol/pose-codec';

const skeleton = skeletonFromCalibration(defaultCalibration);

interface PosedHead {
  /** Floor frame [m]. */
  readonly head: Vec3;
  readonly timeMs: number;
  readonly jump?: boolean;
}

/** The packet of a player whose head is here, with both hands before it and no body. */
export function poseOf({ head, timeMs, jump = false }: PosedHead): Uint8Array {
  const tracked = (position: Vec3) => ({ position, orientation: identity, tracking: 'tracked' as const });
  const pose = {
    head: tracked(head),
    leftHand: tracked(add(head, vec3(-0.2, -0.5, -0.2))),
    rightHand: tracked(add(head, vec3(0.2, -0.5, -0.2))),
    body: null,
  };
  const bytes = encodePose({ timeMs, jump, pose, fingers: unknownFingers }, skeleton);
  if (!bytes) throw new Error('the pose packet of the tests is not finite');
  return bytes;
}
