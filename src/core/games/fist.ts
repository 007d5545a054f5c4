import type { Frame, Pose } from '../math/pose';
import { fromAxes, type Quat, rotate } from '../math/quat';
import type { Side } from '../math/side';
import { add, cross, type MutableVec3, normalise, reject, scale, subtract, type Vec3, vec3 } from '../math/vec3';

/** The middle of the fist in the wrist's frame [m]: 8 cm towards the knuckles, 2.5 cm towards the palm. */
export const fistInWrist: Vec3 = vec3(0, -0.025, -0.08);

/** What a fist closes round (a bow's grip, a ball), of a wrist. */
export const fistOf = (wrist: Pose<Frame>, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  add(wrist.position, rotate(wrist.orientation, fistInWrist, target), target);

/** Out of the fist on the thumb's side, unit. */
export const thumbOf = (side: Side, orientation: Quat): Vec3 =>
  rotate(orientation, vec3(side === 'left' ? 1 : -1, 0, 0));

/** The wrist whose fist closes round `fist`, its knuckles and thumb in these directions as nearly as right angles allow. */
export function wristAround<F extends Frame>(side: Side, fist: Vec3, knuckles: Vec3, thumb: Vec3): Pose<F> {
  const z = scale(normalise(knuckles), -1);
  const outward = scale(normalise(reject(thumb, z)), side === 'left' ? 1 : -1);
  const orientation = fromAxes(outward, cross(z, outward), z);
  return { position: subtract(fist, rotate(orientation, fistInWrist)), orientation };
}
