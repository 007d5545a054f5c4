import {
  add,
  cross,
  type Frame,
  fromAxes,
  type MutablePose,
  type MutableVec3,
  makePose,
  normalise,
  type Pose,
  type Quat,
  reject,
  rotate,
  type Side,
  scale,
  setVec3,
  subtract,
  type Vec3,
  vec3,
} from 'threepoint/math';

/** The centre of the fist in the wrist's frame [m]: 8 cm towards the knuckles, 2.5 cm towards the palm. */
const fistInWrist: Vec3 = vec3(0, -0.025, -0.08);

/** Distance of the palm's skin below the centre of the wrist [m]. */
const palm = 0.015;

/** Returns the centre of a ball with this radius [m] in the palm of a hand, where it is drawn and thrown from. */
export function ballInPalm(wrist: Pose<Frame>, radius: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
  setVec3(target, 0, -palm - radius, fistInWrist.z);
  return add(wrist.position, rotate(wrist.orientation, target, target), target);
}

/** The direction of the thumb in the wrist's frame, unit. */
const thumbInWrist: Readonly<Record<Side, Vec3>> = { left: vec3(1, 0, 0), right: vec3(-1, 0, 0) };

/** Returns the centre of the fist of a wrist, where it holds a bow's grip or a ball. */
export const fistOf = (wrist: Pose<Frame>, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  add(wrist.position, rotate(wrist.orientation, fistInWrist, target), target);

/** Returns the direction of the thumb, unit. */
export const thumbOf = (side: Side, orientation: Quat, target?: MutableVec3): MutableVec3 =>
  rotate(orientation, thumbInWrist[side], target);

const wristX = vec3(0, 0, 0);
const wristY = vec3(0, 0, 0);
const wristZ = vec3(0, 0, 0);

/**
 * Writes the wrist whose fist is at `fist`. The knuckles point in their direction; the thumb is as near to its own as a
 * right angle permits.
 */
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
