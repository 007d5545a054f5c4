import { cross, dot, length, type MutableVec3, normalise, scale, setVec3, type Vec3, vec3 } from './vec3';

/** A rotation as a unit quaternion, component order xyzw wherever it becomes an array. */
export interface Quat {
  readonly x: number;
  readonly y: number;
  readonly z: number;
  readonly w: number;
}

/** A rotation that its owner overwrites: an optional last argument `target`, as with `MutableVec3`. */
export interface MutableQuat {
  x: number;
  y: number;
  z: number;
  w: number;
}

export const identity: Quat = { x: 0, y: 0, z: 0, w: 1 };

export const quat = (x: number, y: number, z: number, w: number): MutableQuat => ({ x, y, z, w });

export function setQuat(target: MutableQuat, x: number, y: number, z: number, w: number): MutableQuat {
  target.x = x;
  target.y = y;
  target.z = z;
  target.w = w;
  return target;
}

export const copyQuat = (q: Quat, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat =>
  setQuat(target, q.x, q.y, q.z, q.w);

/** Reads x, y, z, w from index `at` on. */
export const readQuat = (from: ArrayLike<number>, at: number, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat =>
  setQuat(target, from[at]!, from[at + 1]!, from[at + 2]!, from[at + 3]!);

/** Writes x, y, z, w from index `at` on; returns the index behind them. */
export function writeQuat({ x, y, z, w }: Quat, target: Float32Array | Float64Array, at: number): number {
  target[at] = x;
  target[at + 1] = y;
  target[at + 2] = z;
  target[at + 3] = w;
  return at + 4;
}

/** Returns the rotation b followed by a. */
export const multiply = (a: Quat, b: Quat, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat =>
  setQuat(
    target,
    a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
    a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
    a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
    a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
  );

/** The inverse of a unit quaternion. */
export const conjugate = (q: Quat, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat =>
  setQuat(target, -q.x, -q.y, -q.z, q.w);

/** Returns v rotated by q. */
export function rotate(q: Quat, v: Vec3, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
  const tx = 2 * (q.y * v.z - q.z * v.y);
  const ty = 2 * (q.z * v.x - q.x * v.z);
  const tz = 2 * (q.x * v.y - q.y * v.x);
  return setVec3(
    target,
    v.x + q.w * tx + q.y * tz - q.z * ty,
    v.y + q.w * ty + q.z * tx - q.x * tz,
    v.z + q.w * tz + q.x * ty - q.y * tx,
  );
}

/** Returns v rotated by the inverse of the unit quaternion q. */
export function rotateInverse(q: Quat, v: Vec3, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
  const tx = 2 * (q.z * v.y - q.y * v.z);
  const ty = 2 * (q.x * v.z - q.z * v.x);
  const tz = 2 * (q.y * v.x - q.x * v.y);
  return setVec3(
    target,
    v.x + q.w * tx - q.y * tz + q.z * ty,
    v.y + q.w * ty - q.z * tx + q.x * tz,
    v.z + q.w * tz - q.x * ty + q.y * tx,
  );
}

/** Returns q scaled to length 1; the identity where it has no length. */
export function normaliseQuat(q: Quat, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat {
  const squares = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  const l = squares > 1e-280 && squares < 1e280 ? Math.sqrt(squares) : Math.hypot(q.x, q.y, q.z, q.w);
  return l < 1e-12 ? copyQuat(identity, target) : setQuat(target, q.x / l, q.y / l, q.z / l, q.w / l);
}

/** The rotation by `angle` [rad] about a unit axis. */
export function fromAxisAngle(axis: Vec3, angle: number, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat {
  const s = Math.sin(angle / 2);
  return setQuat(target, axis.x * s, axis.y * s, axis.z * s, Math.cos(angle / 2));
}

const unitFrom = vec3(0, 0, 0);
const unitTo = vec3(0, 0, 0);
const normal = vec3(0, 0, 0);

/**
 * The smallest rotation from the direction of one vector to that of another; half a turn about any normal when they
 * oppose.
 */
export function rotationBetween(from: Vec3, to: Vec3, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat {
  const a = normalise(from, undefined, unitFrom);
  const b = normalise(to, undefined, unitTo);
  const w = 1 + dot(a, b);
  if (w < 1e-9) {
    if (Math.abs(a.x) < 0.9) setVec3(normal, 0, a.z, -a.y);
    else setVec3(normal, -a.z, 0, a.x);
    normalise(normal, undefined, normal);
    return setQuat(target, normal.x, normal.y, normal.z, 0);
  }
  const c = cross(a, b, normal);
  return normaliseQuat(setQuat(target, c.x, c.y, c.z, w), target);
}

/** The rotation whose x, y, z axes are these (orthonormal, right-handed). */
export function fromAxes(x: Vec3, y: Vec3, z: Vec3, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat {
  const trace = x.x + y.y + z.z;
  if (trace > 0) {
    const s = 2 * Math.sqrt(trace + 1);
    setQuat(target, (y.z - z.y) / s, (z.x - x.z) / s, (x.y - y.x) / s, s / 4);
  } else if (x.x > y.y && x.x > z.z) {
    const s = 2 * Math.sqrt(1 + x.x - y.y - z.z);
    setQuat(target, s / 4, (x.y + y.x) / s, (z.x + x.z) / s, (y.z - z.y) / s);
  } else if (y.y > z.z) {
    const s = 2 * Math.sqrt(1 + y.y - x.x - z.z);
    setQuat(target, (x.y + y.x) / s, s / 4, (z.y + y.z) / s, (z.x - x.z) / s);
  } else {
    const s = 2 * Math.sqrt(1 + z.z - x.x - y.y);
    setQuat(target, (x.z + z.x) / s, (y.z + z.y) / s, s / 4, (x.y - y.x) / s);
  }
  return normaliseQuat(target, target);
}

const frameX = vec3(0, 0, 0);
const frameY = vec3(0, 0, 0);
const frameZ = vec3(0, 0, 0);
const toFrame = quat(0, 0, 0, 1);

/**
 * Writes the rotation whose x axis is along main and whose z axis is normal to main and side; false where these are
 * parallel.
 */
function frameOf(main: Vec3, side: Vec3, target: MutableQuat): boolean {
  normalise(main, undefined, frameX);
  cross(frameX, side, frameZ);
  const across = length(frameZ);
  if (across < 1e-6 * (length(side) + 1e-12)) return false;
  scale(frameZ, 1 / across, frameZ);
  fromAxes(frameX, cross(frameZ, frameX, frameY), frameZ, target);
  return true;
}

/** Two directions of an object at rest, in its own frame, computed once. */
export interface RestDirections {
  readonly main: Vec3;
  /** The rotation from the object's frame to the one that main and side span; null: they are parallel. */
  readonly inverse: Quat | null;
}

export function restDirections(main: Vec3, side: Vec3): RestDirections {
  const spanned = quat(0, 0, 0, 1);
  return { main, inverse: frameOf(main, side, spanned) ? conjugate(spanned) : null };
}

/**
 * The rotation that takes the main direction at rest to `toMain` exactly and the side as near to `toSide` as that
 * allows. Parallel main and side: the twist is the smallest rotation's.
 */
export const alignDirections = (
  { main, inverse }: RestDirections,
  toMain: Vec3,
  toSide: Vec3,
  target: MutableQuat = quat(0, 0, 0, 1),
): MutableQuat =>
  inverse && frameOf(toMain, toSide, toFrame)
    ? multiply(toFrame, inverse, target)
    : rotationBetween(main, toMain, target);

/**
 * Interpolates along the shorter arc from a (t = 0) to b (t = 1), both unit; t beyond [0, 1] extrapolates. Half a turn
 * apart: one of the two arcs.
 */
export function slerp(a: Quat, b: Quat, t: number, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat {
  const cosine = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
  const sign = cosine < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(1, Math.abs(cosine)));
  const sine = Math.sin(angle);
  const u = sine < 1e-6 ? 1 - t : Math.sin((1 - t) * angle) / sine;
  const v = (sine < 1e-6 ? t : Math.sin(t * angle) / sine) * sign;
  setQuat(target, a.x * u + b.x * v, a.y * u + b.y * v, a.z * u + b.z * v, a.w * u + b.w * v);
  return normaliseQuat(target, target);
}

/** The unit axis times the angle in [0, π] [rad]; q and −q give the same vector. */
export function toRotationVector(q: Quat, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
  const sine = Math.sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
  const angle = 2 * Math.atan2(sine, Math.abs(q.w));
  // The limit of angle / sine for no rotation is 2.
  const factor = (q.w < 0 ? -1 : 1) * (sine < 1e-12 ? 2 : angle / sine);
  return setVec3(target, q.x * factor, q.y * factor, q.z * factor);
}

/** The angle [0, π] between two rotations; q and −q are the same rotation. */
export function angleBetween(a: Quat, b: Quat): number {
  // The components of conjugate(a)·b.
  const x = a.w * b.x - a.x * b.w - a.y * b.z + a.z * b.y;
  const y = a.w * b.y + a.x * b.z - a.y * b.w - a.z * b.x;
  const z = a.w * b.z - a.x * b.y + a.y * b.x - a.z * b.w;
  const w = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
  return 2 * Math.atan2(Math.sqrt(x * x + y * y + z * z), Math.abs(w));
}

/**
 * The twist of q = swing·twist: about the unit axis, while the swing's axis is at right angles to it. A half-turn
 * swing: the identity.
 */
export function twistOf(q: Quat, axis: Vec3, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat {
  const along = q.x * axis.x + q.y * axis.y + q.z * axis.z;
  return normaliseQuat(setQuat(target, axis.x * along, axis.y * along, axis.z * along, q.w), target);
}

/** The signed angle (−π, π] of a rotation about a unit axis, from its twist part. */
export function twistAngle(q: Quat, axis: Vec3): number {
  const along = q.x * axis.x + q.y * axis.y + q.z * axis.z;
  const angle = 2 * Math.atan2(along, q.w);
  return angle > Math.PI ? angle - 2 * Math.PI : angle <= -Math.PI ? angle + 2 * Math.PI : angle;
}

/** The rotation by at most `limit` [rad] in the direction of q. */
export function limitAngle(q: Quat, limit: number, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat {
  // The limit is rarely reached, which a cosine shows without the angle.
  if (Math.abs(q.w) >= Math.cos(Math.min(limit, Math.PI) / 2)) return copyQuat(q, target);
  return slerp(identity, q, limit / angleBetween(identity, q), target);
}

/** Returns the angles [rad] about x, y, z of the intrinsic decomposition Ry·Rx·Rz. */
export function toEulerYxz(q: Quat, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
  const m12 = 2 * (q.y * q.z - q.x * q.w);
  return setVec3(
    target,
    Math.asin(Math.max(-1, Math.min(1, -m12))),
    Math.atan2(2 * (q.x * q.z + q.y * q.w), 1 - 2 * (q.x * q.x + q.y * q.y)),
    Math.atan2(2 * (q.x * q.y + q.z * q.w), 1 - 2 * (q.x * q.x + q.z * q.z)),
  );
}
