import type { MutablePose } from 'threepoint/core/math/pose';
import { fromAxes, type MutableQuat, quat } from 'threepoint/core/math/quat';
import { cross, type MutableVec3, normalise, scale, setVec3, up, type Vec3, vec3 } from 'threepoint/core/math/vec3';

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

const x = vec3(0, 0, 0);
const y = vec3(0, 0, 0);
const z = vec3(0, 0, 0);

/** The rotation that looks along a direction, head upright. */
export function lookAlong(direction: Vec3, target?: MutableQuat): MutableQuat {
  scale(normalise(direction, undefined, z), -1, z);
  normalise(cross(up, z, x), undefined, x);
  return fromAxes(x, cross(z, x, y), z, target);
}

/** No person stands still: how far head and hands have drifted together at a time [s], some millimetres. */
export const swayAt = (time: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, 0.006 * Math.sin(time * 0.61), 0.002 * Math.sin(time * 1.5), 0.005 * Math.sin(time * 0.43 + 1));

/** A hand or head that is seen, at the origin until its pose is written. */
export const makeTracked = (): MutablePose<'floor'> & { readonly tracking: 'tracked' } => ({
  position: vec3(0, 0, 0),
  orientation: quat(0, 0, 0, 1),
  tracking: 'tracked',
});
