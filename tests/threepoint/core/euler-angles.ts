import { fromAxisAngle, multiply, type Quat } from '../../../src/threepoint/core/math/quat';
import { type Vec3, vec3 } from '../../../src/threepoint/core/math/vec3';

/** Ry·Rx·Rz of angles [rad] about x, y, z: the inverse of `toEulerYxz`. */
export const fromEulerYxz = (angles: Vec3): Quat => {
  const about = (x: number, y: number, z: number, angle: number) => fromAxisAngle(vec3(x, y, z), angle);
  return multiply(about(0, 1, 0, angles.y), multiply(about(1, 0, 0, angles.x), about(0, 0, 1, angles.z)));
};
