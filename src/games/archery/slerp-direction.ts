import {
  identity,
  type MutableVec3,
  normalise,
  quat,
  rotate,
  rotationBetween,
  slerp,
  type Vec3,
  vec3,
} from 'threepoint/math';

const arc = quat(0, 0, 0, 1);
const turned = vec3(0, 0, 0);

/** Writes the unit vector at the fraction `t` of the shorter arc from `a` to `b`, both unit. */
export function slerpDirection(a: Vec3, b: Vec3, t: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
  rotate(slerp(identity, rotationBetween(a, b, arc), t, arc), a, turned);
  return normalise(turned, a, target);
}
