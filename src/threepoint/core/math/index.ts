// "threepoint/math": vectors, quaternions, poses and transforms between named frames, dampers and seeded randomness.
export { wrapAngle } from './angle';
export { bisect } from './bisection';
export { clamp, damp, dampVec3, smoothingFactor, smoothstep } from './damper';
export type {
  Frame,
  MutablePose,
  MutableTrackedPose,
  MutableTransform,
  Pose,
  TrackedPose,
  Transform,
} from './pose';
export {
  composeTransforms,
  copyPose,
  invertTransform,
  isTracked,
  makePose,
  makeTrackedPose,
  makeTransform,
  transformPoint,
  transformPose,
  transformTracked,
} from './pose';
export type { MutableQuat, Quat } from './quat';
export {
  angleBetween,
  conjugate,
  copyQuat,
  fromAxes,
  fromAxisAngle,
  identity,
  multiply,
  normaliseQuat,
  quat,
  rotate,
  rotationBetween,
  setQuat,
  slerp,
  toRotationVector,
  twistAngle,
  twistOf,
} from './quat';
export { createNormalRandom, createRandom, nextRandom, type RandomState } from './random';
export type { Ray } from './ray';
export { otherSide, type Side, sides } from './side';
export { median } from './statistics';
export { childrenOf } from './tree';
export type { MutableVec3, Vec3 } from './vec3';
export {
  add,
  addScaled,
  backward,
  copyVec3,
  cross,
  distance,
  dot,
  down,
  forward,
  isFiniteVec3,
  length,
  lerp,
  normalise,
  reject,
  right,
  scale,
  setVec3,
  subtract,
  up,
  vec3,
  zero,
} from './vec3';
