import { cross, dot, normalise, reject, subtract, type Vec3 } from 'threepoint/core/math/vec3';

/** The signed angle (−π, π] [rad] about shoulder→wrist from one elbow to another: the error in swivel. */
export function swivelAngle(shoulder: Vec3, wrist: Vec3, elbow: Vec3, otherElbow: Vec3): number {
  const axis = normalise(subtract(wrist, shoulder));
  const from = reject(subtract(elbow, shoulder), axis);
  const to = reject(subtract(otherElbow, shoulder), axis);
  return Math.atan2(dot(cross(from, to), axis), dot(from, to));
}
