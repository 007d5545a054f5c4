/**
 * A point or direction; metres where it is a position. Right-handed, +Y up, −Z forward.
 *
 * V8 gives all literals `{ x, y, z }` of a program one hidden class. As long as only numbers are ever written into it,
 * a vector's numbers are stored in place; one literal `{ x: schema, y: schema, z: schema }` anywhere makes every number
 * stored in any vector an object of its own on the heap (tests/page/boxed-numbers.test.ts). The same holds for `Quat`.
 */
export interface Vec3 {
  readonly x: number;
  readonly y: number;
  readonly z: number;
}

/**
 * A vector that its owner overwrites. Every function that makes a vector takes one as its optional last argument
 * `target`, writes the result into it and returns it; target may be one of the arguments. Without it a new vector is
 * made.
 */
export interface MutableVec3 {
  x: number;
  y: number;
  z: number;
}

export const zero: Vec3 = { x: 0, y: 0, z: 0 };
export const right: Vec3 = { x: 1, y: 0, z: 0 };
export const up: Vec3 = { x: 0, y: 1, z: 0 };
export const down: Vec3 = { x: 0, y: -1, z: 0 };
export const forward: Vec3 = { x: 0, y: 0, z: -1 };
export const backward: Vec3 = { x: 0, y: 0, z: 1 };

export const vec3 = (x: number, y: number, z: number): MutableVec3 => ({ x, y, z });

export function setVec3(target: MutableVec3, x: number, y: number, z: number): MutableVec3 {
  target.x = x;
  target.y = y;
  target.z = z;
  return target;
}

export const copyVec3 = (a: Vec3, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 => setVec3(target, a.x, a.y, a.z);

export const add = (a: Vec3, b: Vec3, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, a.x + b.x, a.y + b.y, a.z + b.z);

export const subtract = (a: Vec3, b: Vec3, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, a.x - b.x, a.y - b.y, a.z - b.z);

export const scale = (a: Vec3, factor: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, a.x * factor, a.y * factor, a.z * factor);

/** Returns a + b·factor. */
export const addScaled = (a: Vec3, b: Vec3, factor: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, a.x + b.x * factor, a.y + b.y * factor, a.z + b.z * factor);

export const dot = (a: Vec3, b: Vec3): number => a.x * b.x + a.y * b.y + a.z * b.z;

export const cross = (a: Vec3, b: Vec3, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);

/** Returns the length of a vector; the slower Math.hypot only where squares overflow or vanish. */
function hypotenuse(x: number, y: number, z: number): number {
  const squares = x * x + y * y + z * z;
  if (squares > 1e-280 && squares < 1e280) return Math.sqrt(squares);
  return x === 0 && y === 0 && z === 0 ? 0 : Math.hypot(x, y, z);
}

export const length = (a: Vec3): number => hypotenuse(a.x, a.y, a.z);

export const distance = (a: Vec3, b: Vec3): number => hypotenuse(a.x - b.x, a.y - b.y, a.z - b.z);

/** The unit vector along a; `fallback` where a is shorter than 1e-9. */
export function normalise(a: Vec3, fallback: Vec3 = up, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 {
  const l = length(a);
  return l < 1e-9 ? copyVec3(fallback, target) : scale(a, 1 / l, target);
}

/** The part of a at right angles to the unit vector `axis`. */
export const reject = (a: Vec3, axis: Vec3, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  addScaled(a, axis, -dot(a, axis), target);

/**
 * Interpolates from a (t = 0) to b (t = 1) along the straight line; t beyond [0, 1] extrapolates. t = 1 may miss b by
 * rounding.
 */
export const lerp = (a: Vec3, b: Vec3, t: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t);

/** Writes x, y, z from index `at` on; returns the index behind them. */
export function writeVec3({ x, y, z }: Vec3, target: Float32Array | Float64Array, at: number): number {
  target[at] = x;
  target[at + 1] = y;
  target[at + 2] = z;
  return at + 3;
}

/** Reads x, y, z from index `at` on. */
export const readVec3 = (from: ArrayLike<number>, at: number, target: MutableVec3 = vec3(0, 0, 0)): MutableVec3 =>
  setVec3(target, from[at]!, from[at + 1]!, from[at + 2]!);

export const isFiniteVec3 = (a: Vec3): boolean => Number.isFinite(a.x + a.y + a.z);
