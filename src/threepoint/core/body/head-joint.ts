import type { Frame, Pose } from '../math/pose';
import { rotate } from '../math/quat';
import { type MutableVec3, subtract, type Vec3, vec3 } from '../math/vec3';

/**
 * Returns the head joint [m] for a headset at this pose, same frame. `eyesInHead`: the offset from the joint to the
 * headset's origin, head frame.
 */
export function headJointOf(head: Pose<Frame>, eyesInHead: Vec3, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
  const { position } = head;
  rotate(head.orientation, eyesInHead, target);
  return subtract(position, target, target);
}
