import { type Frame, type MutablePose, makePose, type Pose } from 'threepoint/core/math/pose';
import { fromAxes, type Quat, rotate } from 'threepoint/core/math/quat';
import type { Side } from 'threepoint/core/math/side';
import {
  add,
  cross,
  type MutableVec3,
  normalise,
  reject,
  scale,
  setVec3,
  subtract,
  type Vec3,
  vec3,
} from 'threepoint/core/math/vec3';

/** The middle of the fist in the wrist's frame [m]: 8 cm towards the knuckles, 2.5 cm towards the palm. */
export const fistInWrist: Vec3 = vec3(0, -0.025, -0.08);

/** The skin of the palm lies this far below the wrist's middle [m]. */
const palm = 0.015;

/** The middle of a ball of this radius [m] that lies in the palm of a hand: it is drawn there, and thrown from there. */
export function ballInPalm(wrist: Pose<Frame>, radius: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
  setVec3(target, 0, -palm - radius, fistInWrist.z);
  return add(wrist.position, rotate(wrist.orientation, target, target), target);
}

/** Out of the fist on the thumb's side, in the wrist's frame. */
const thumbInWrist: Readonly<Record<Side, Vec3>> = { left: vec3(1, 0, 0), right: vec3(-1, 0, 0) };

/** What a fist closes round (a bow's grip, a ball), of a wrist. */
export const fistOf = (wrist: Pose<Frame>, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  add(wrist.position, rotate(wrist.orientation, fistInWrist, target), target);

/** Out of the fist on the thumb's side, unit. */
export const thumbOf = (side: Side, orientation: Quat, target?: MutableVec3): MutableVec3 =>
  rotate(orientation, thumbInWrist[side], target);

const wristX = vec3(0, 0, 0);
const wristY = vec3(0, 0, 0);
const wristZ = vec3(0, 0, 0);

/** The wrist whose fist closes round `fist`, its knuckles and thumb in these directions as nearly as right angles allow. */
export function wristAround<F extends Frame>(
  side: Side,
  fist: Vec3,
  knuckles: Vec3,
  thumb: Vec3,
  target: MutablePose<F> = makePose<F>(),
): MutablePose<F> {
  const z = scale(normalise(knuckles, undefined, wristZ), -1, wristZ);
  const x = normalise(reject(thumb, z, wristX), undefined, wristX);
  scale(x, side === 'left' ? 1 : -1, x);
  fromAxes(x, cross(z, x, wristY), z, target.orientation);
  subtract(fist, rotate(target.orientation, fistInWrist, wristY), target.position);
  return target;
}
