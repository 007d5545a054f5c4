import { fromAxisAngle, multiply, type Quat, type Vec3, vec3 } from 'threepoint/math';

/** Ry·Rx·Rz of angles [rad] about x, y, z: the inverse of `toEulerYxz`. */
export const fromEulerYxz = (angles: Vec3): Quat => {
  const about = (x: number, y: number, z: number, angle: number) => fromAxisAngle(vec3(x, y, z), angle);
  return multiply(about(0, 1, 0, angles.y), multiply(about(1, 0, 0, angles.x), about(0, 0, 1, angles.z)));
};
