import type { Pose, Transform } from '../math/pose';
import { conjugate, fromAxisAngle, type Quat, rotate } from '../math/quat';
import { cross, length, right, scale, up, type Vec3, vec3 } from '../math/vec3';

/**
 * The yaw of a head as a rotation about +Y, from its right axis, so that looking straight up or down does not matter.
 * A head on its side has none: then the gaze's, then that of −Z.
 */
export function headingOf(orientation: Quat): Quat {
  const candidates = [cross(up, rotate(orientation, right)), rotate(orientation, vec3(0, 0, -1))];
  for (const candidate of candidates) {
    const ahead: Vec3 = { ...candidate, y: 0 };
    if (length(ahead) >= 1e-3) return fromAxisAngle(up, Math.atan2(-ahead.x, -ahead.z));
  }
  return fromAxisAngle(up, 0);
}

/** From the heading frame (origin on the floor under the headset, yaw of the head) to the floor frame. */
export function floorFromHeading(head: Pose<'floor'>): Transform<'floor', 'heading'> {
  return { position: { ...head.position, y: 0 }, orientation: headingOf(head.orientation) };
}

/** The inverse of `floorFromHeading`. */
export function headingFromFloor(head: Pose<'floor'>): Transform<'heading', 'floor'> {
  const orientation = conjugate(headingOf(head.orientation));
  return { position: scale(rotate(orientation, { ...head.position, y: 0 }), -1), orientation };
}
