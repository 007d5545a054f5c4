import { conjugate, copyQuat, type MutableQuat, multiply, type Quat, quat, rotate, rotateInverse } from './quat';
import { add, copyVec3, type MutableVec3, scale, subtract, type Vec3, vec3 } from './vec3';

/**
 * The coordinate frames of the project, all right-handed, +Y up, −Z forward, metres (threepoint/README.md, Frames).
 * floor: WebXR `local-floor`. heading: origin on the floor under the headset, yaw of the head. body: origin on the
 * floor under the head joint, yaw of the body (tracking/body-heading). arena: shared by players. tracker: a tracker's
 * own. joint: a joint's own.
 */
export type Frame = 'floor' | 'heading' | 'body' | 'arena' | 'tracker' | 'joint';

declare const frame: unique symbol;

/** Position [m] and orientation of something in frame F; F exists only in the type. */
export interface Pose<F extends Frame> {
  readonly position: Vec3;
  readonly orientation: Quat;
  readonly [frame]?: F;
}

/** tracked: seen in this frame. emulated: the device guesses the position (WebXR `emulatedPosition`). */
export type TrackedPose = Pose<'floor'> & { readonly tracking: 'tracked' | 'emulated' };

/** Returns whether a point is tracked: neither lost nor emulated. */
export const isTracked = (pose: TrackedPose | null | undefined): pose is TrackedPose => pose?.tracking === 'tracked';

/** Returns the pose if it is tracked; null: lost or emulated. */
export const trackedOrNull = (pose: TrackedPose | null): TrackedPose | null => (isTracked(pose) ? pose : null);

/** A pose that its owner overwrites: an optional last argument `target`, as with `MutableVec3`. */
export interface MutablePose<F extends Frame> extends Pose<F> {
  readonly position: MutableVec3;
  readonly orientation: MutableQuat;
}

/** A tracked pose that its owner overwrites. */
export interface MutableTrackedPose extends MutablePose<'floor'> {
  tracking: TrackedPose['tracking'];
}

declare const transformFrames: unique symbol;

/** The rigid transform that takes coordinates in From to coordinates in To; named toFromFrom: `headingFromFloor`. */
export interface Transform<To extends Frame, From extends Frame> {
  readonly position: Vec3;
  readonly orientation: Quat;
  readonly [transformFrames]?: readonly [To, From];
}

/** A transform that its owner overwrites. */
export interface MutableTransform<To extends Frame, From extends Frame> extends Transform<To, From> {
  readonly position: MutableVec3;
  readonly orientation: MutableQuat;
}

/** Returns a pose at the origin without rotation, for buffers. */
export const makePose = <F extends Frame>(): MutablePose<F> => ({
  position: vec3(0, 0, 0),
  orientation: quat(0, 0, 0, 1),
});

/** Returns a tracked pose at the origin, for buffers. */
export const makeTrackedPose = (): MutableTrackedPose => ({ ...makePose<'floor'>(), tracking: 'tracked' });

/**
 * Returns whether position and rotation are valid: finite numbers, also when squared, and a quaternion with a length.
 */
export function isFinitePose({ position: p, orientation: o }: Pose<Frame>): boolean {
  const turned = o.x * o.x + o.y * o.y + o.z * o.z + o.w * o.w;
  return turned > 0 && Number.isFinite(turned + p.x * p.x + p.y * p.y + p.z * p.z);
}

export function copyPose<F extends Frame>(pose: Pose<F>, target: MutablePose<F> = makePose()): MutablePose<F> {
  copyVec3(pose.position, target.position);
  copyQuat(pose.orientation, target.orientation);
  return target;
}

export const makeTransform = <To extends Frame, From extends Frame>(): MutableTransform<To, From> => makePose();

/** Returns a point's coordinates in To. */
export function transformPoint<To extends Frame, From extends Frame>(
  t: Transform<To, From>,
  point: Vec3,
  target: MutableVec3 = vec3(0, 0, 0),
): MutableVec3 {
  rotate(t.orientation, point, target);
  return add(t.position, target, target);
}

/** Returns a point's coordinates in From: the inverse of `transformPoint`. */
export function untransformPoint<To extends Frame, From extends Frame>(
  t: Transform<To, From>,
  point: Vec3,
  target: MutableVec3 = vec3(0, 0, 0),
): MutableVec3 {
  subtract(point, t.position, target);
  return rotateInverse(t.orientation, target, target);
}

/** Returns a pose in To. */
export function transformPose<To extends Frame, From extends Frame>(
  t: Transform<To, From>,
  pose: Pose<From>,
  target: MutablePose<To> = makePose(),
): MutablePose<To> {
  transformPoint(t, pose.position, target.position);
  multiply(t.orientation, pose.orientation, target.orientation);
  return target;
}

/** Returns the pose in To if it is tracked; null: lost or emulated. */
export function transformTracked<To extends Frame>(
  t: Transform<To, 'floor'>,
  pose: TrackedPose | null,
  target?: MutablePose<To>,
): MutablePose<To> | null {
  const seen = trackedOrNull(pose);
  return seen && transformPose(t, seen, target);
}

/** Returns the transform from From to To by way of Via. */
export function composeTransforms<To extends Frame, Via extends Frame, From extends Frame>(
  toFromVia: Transform<To, Via>,
  viaFromFrom: Transform<Via, From>,
  target: MutableTransform<To, From> = makeTransform(),
): MutableTransform<To, From> {
  transformPoint(toFromVia, viaFromFrom.position, target.position);
  multiply(toFromVia.orientation, viaFromFrom.orientation, target.orientation);
  return target;
}

/**
 * Returns the inverse transform: `toFromFrom` becomes `fromFromTo`. The orientation must be unit; target may be `t`.
 */
export function invertTransform<To extends Frame, From extends Frame>(
  t: Transform<To, From>,
  target: MutableTransform<From, To> = makeTransform(),
): MutableTransform<From, To> {
  conjugate(t.orientation, target.orientation);
  rotate(target.orientation, t.position, target.position);
  scale(target.position, -1, target.position);
  return target;
}
