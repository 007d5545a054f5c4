import {
  cross,
  fromAxes,
  type MutableQuat,
  type MutableVec3,
  normalise,
  scale,
  setVec3,
  up,
  type Vec3,
  vec3,
} from 'threepoint/math';

/**
 * Arm length (shoulder to wrist) and half the shoulder width, as shares of the standing eye height (averages of the
 * body model).
 */
export const armRatio = 0.36;
export const halfShoulderRatio = 0.114;
/**
 * Distances of the shoulders below the eyes and behind them, as shares of the arm length, for a gaze along the trunk.
 */
export const shoulderDropRatio = 0.35;
export const shoulderBehindRatio = 0.19;

/** Returns the minimum-jerk interpolation from 0 to 1, by which hands move (Flash & Hogan 1985). */
export const minimumJerk = (t: number): number => t * t * t * (10 - 15 * t + 6 * t * t);

/** Returns the yaw of a direction [rad]; 0: ahead, positive: to the left. */
export const yawOf = (direction: Vec3): number => Math.atan2(-direction.x, -direction.z);

const x = vec3(0, 0, 0);
const y = vec3(0, 0, 0);
const z = vec3(0, 0, 0);

/** Returns the rotation that looks along a direction, with the head upright. */
export function lookAlong(direction: Vec3, target?: MutableQuat): MutableQuat {
  scale(normalise(direction, undefined, z), -1, z);
  normalise(cross(up, z, x), undefined, x);
  return fromAxes(x, cross(z, x, y), z, target);
}

/** Returns the postural sway of head and hands at a time [s], some millimetres. */
export const swayAt = (time: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, 0.006 * Math.sin(time * 0.61), 0.002 * Math.sin(time * 1.5), 0.005 * Math.sin(time * 0.43 + 1));
