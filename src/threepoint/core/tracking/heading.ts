import { smoothstep } from '../math/damper';
import { invertTransform, type MutableTransform, makeTransform, type Pose, type Transform } from '../math/pose';
import { fromAxisAngle, type MutableQuat, type Quat, quat, rotate } from '../math/quat';
import { forward, right, setVec3, up, vec3 } from '../math/vec3';

const axis = vec3(0, 0, 0);

/**
 * Returns the yaw [rad] of a head about +Y, from its right axis, so that it is defined when looking up or down. For a
 * head on its side the yaw of the gaze, then that of −Z.
 */
export function yawOf(orientation: Quat): number {
  const side = rotate(orientation, right, axis);
  // The horizontal direction at right angles to the right axis is ahead.
  if (Math.sqrt(side.x * side.x + side.z * side.z) >= 1e-3) return Math.atan2(-side.z, side.x);
  const gaze = rotate(orientation, forward, axis);
  return Math.sqrt(gaze.x * gaze.x + gaze.z * gaze.z) >= 1e-3 ? Math.atan2(-gaze.x, -gaze.z) : 0;
}

/** Returns the yaw of a head as a rotation about +Y; see `yawOf`. */
export const headingOf = (orientation: Quat, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat =>
  fromAxisAngle(up, yawOf(orientation), target);

/**
 * Returns the transform from the heading frame (origin on the floor under the headset, yaw of the head) to the floor
 * frame.
 */
export function floorFromHeading(
  head: Pose<'floor'>,
  target: MutableTransform<'floor', 'heading'> = makeTransform(),
): MutableTransform<'floor', 'heading'> {
  setVec3(target.position, head.position.x, 0, head.position.z);
  headingOf(head.orientation, target.orientation);
  return target;
}

/** The inverse of `floorFromHeading`. */
export const headingFromFloor = (head: Pose<'floor'>): Transform<'heading', 'floor'> =>
  invertTransform(floorFromHeading(head));

/** The horizontal length of a head's right axis at which the confidence of its heading is 0, and at which it is 1. */
const [undefinedHeading, definedHeading] = [0.35, 0.7];

/** The direction that a head faces along the floor. */
export interface Heading {
  /** About +Y [rad], see `yawOf`. */
  yaw: number;
  /** The confidence in [0, 1]; 0 for a head on its side, whose heading is independent of the body's. */
  confidence: number;
}

/**
 * Writes the heading of a head with this orientation, floor frame. On its side: `yawOf`'s fallback, with confidence 0.
 */
export function readHeading(orientation: Quat, target: Heading = { yaw: Number.NaN, confidence: Number.NaN }): Heading {
  target.yaw = yawOf(orientation);
  const { x, z } = rotate(orientation, right, axis);
  target.confidence = smoothstep(undefinedHeading, definedHeading, Math.sqrt(x * x + z * z));
  return target;
}
