import { fromAxes, type Quat } from '../math/quat';
import { cross, normalise, scale, up, type Vec3 } from '../math/vec3';

/** Shoulder to wrist and half the width of the shoulders as shares of the standing eye height (the body model's averages). */
export const armShare = 0.36;
export const shoulderShare = 0.114;
/** Shoulders below the eyes, and behind eyes that look along the trunk, as shares of the arm. */
export const shoulderDrop = 0.35;
export const shoulderBehind = 0.19;

/** From 0 to 1 with neither speed nor acceleration at the ends: how hands move between two places (Flash & Hogan 1985). */
export const minimumJerk = (t: number): number => t * t * t * (10 - 15 * t + 6 * t * t);

/** Yaw of a direction [rad]; 0: ahead, positive: to the left. */
export const yawOf = (direction: Vec3): number => Math.atan2(-direction.x, -direction.z);

/** The rotation that looks along a direction, head upright. */
export function lookAlong(direction: Vec3): Quat {
  const z = scale(normalise(direction), -1);
  const x = normalise(cross(up, z));
  return fromAxes(x, cross(z, x), z);
}
