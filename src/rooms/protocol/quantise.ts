import {
  clamp,
  cross,
  type MutableQuat,
  type MutableVec3,
  normalise,
  normaliseQuat,
  type Quat,
  quat,
  setQuat,
  setVec3,
  type Vec3,
  vec3,
} from 'threepoint/math';
import type { BitReader, BitWriter } from './bit-stream';

/** Positions in a packet are multiples of this [m]. */
export const placeUnit = 0.00025;

/**
 * Returns the largest step m = 2^(b−1) − 1 of a signed number of b bits. A step in [−m, m] is written as step + m: zero
 * is exact, and the code 2^b − 1 is invalid.
 */
export const maxSteps = (bits: number): number => (1 << (bits - 1)) - 1;

/** Returns the nearest step to a value in [−range, range]; clamped beyond. */
export const toStep = (value: number, range: number, bits: number): number =>
  Math.round(clamp(value / range, -1, 1) * maxSteps(bits));

export const fromStep = (step: number, range: number, bits: number): number => (step / maxSteps(bits)) * range;

/**
 * Returns the step of a non-uniform quantiser for values near 0: half the uniform step at 0, 1.5 times at ±range,
 * clamped beyond.
 */
export function toCentredStep(value: number, range: number, bits: number): number {
  const step = toStep((Math.sqrt(1 + 8 * clamp(Math.abs(value) / range, 0, 1)) - 1) / 2, 1, bits);
  return value < 0 ? -step : step;
}

export function fromCentredStep(step: number, range: number, bits: number): number {
  const even = fromStep(step, 1, bits);
  return (range * even * (1 + Math.abs(even))) / 2;
}

export const writeStep = (writer: BitWriter, step: number, bits: number): void =>
  writer.write(step + maxSteps(bits), bits);

/** Returns the step; null for the invalid code. */
export function readStep(reader: BitReader, bits: number): number | null {
  const most = maxSteps(bits);
  const step = reader.read(bits) - most;
  return step <= most ? step : null;
}

/**
 * A rotation in smallest-three form: the index of the largest of x, y, z, w (made positive), and the other three. A
 * buffer.
 */
export interface QuatSteps {
  largest: number;
  a: number;
  b: number;
  c: number;
}

export const makeQuatSteps = (): QuatSteps => ({ largest: 3, a: 0, b: 0, c: 0 });

/** Range of the other three components: ±1/√2. */
const range = Math.SQRT1_2;

/**
 * Writes the nearest steps of a unit quaternion, the same for q and −q. Of equal largest components the first of w, x,
 * y, z is taken.
 */
export function toQuatSteps({ x, y, z, w }: Quat, bits: number, target: QuatSteps = makeQuatSteps()): QuatSteps {
  let largest = 3;
  let most = w;
  if (Math.abs(x) > Math.abs(most)) [largest, most] = [0, x];
  if (Math.abs(y) > Math.abs(most)) [largest, most] = [1, y];
  if (Math.abs(z) > Math.abs(most)) [largest, most] = [2, z];
  const sign = most < 0 ? -1 : 1;
  target.largest = largest;
  target.a = toStep(sign * (largest === 0 ? y : x), range, bits);
  target.b = toStep(sign * (largest <= 1 ? z : y), range, bits);
  target.c = toStep(sign * (largest <= 2 ? w : z), range, bits);
  return target;
}

export function fromQuatSteps(steps: QuatSteps, bits: number, target: MutableQuat = quat(0, 0, 0, 1)): MutableQuat {
  const a = fromStep(steps.a, range, bits);
  const b = fromStep(steps.b, range, bits);
  const c = fromStep(steps.c, range, bits);
  const d = Math.sqrt(Math.max(0, 1 - a * a - b * b - c * c));
  if (steps.largest === 0) setQuat(target, d, a, b, c);
  else if (steps.largest === 1) setQuat(target, a, d, b, c);
  else if (steps.largest === 2) setQuat(target, a, b, d, c);
  else setQuat(target, a, b, c, d);
  return normaliseQuat(target, target);
}

export function writeQuat(writer: BitWriter, { largest, a, b, c }: QuatSteps, bits: number): void {
  writer.write(largest, 2);
  writeStep(writer, a, bits);
  writeStep(writer, b, bits);
  writeStep(writer, c, bits);
}

/** Reads a rotation; null if the fourth component would not be the largest. */
export function readQuat(reader: BitReader, bits: number, target: QuatSteps = makeQuatSteps()): QuatSteps | null {
  target.largest = reader.read(2);
  const a = readStep(reader, bits);
  const b = readStep(reader, bits);
  const c = readStep(reader, bits);
  if (a === null || b === null || c === null) return null;
  target.a = a;
  target.b = b;
  target.c = c;
  const most = maxSteps(bits);
  const squares = (a * a + b * b + c * c) / (2 * most * most);
  const others = Math.max(Math.abs(a), Math.abs(b), Math.abs(c)) / most;
  // Rounding moves each of four equal components by half a step; the tolerance of two steps is enough.
  const rest = Math.sqrt(Math.max(0, 1 - squares)) * Math.SQRT2;
  return rest >= others - 4 / most ? target : null;
}

/** A vector of three steps. A buffer. */
export interface VecSteps {
  x: number;
  y: number;
  z: number;
}

export const makeVecSteps = (): VecSteps => ({ x: 0, y: 0, z: 0 });

/** A direction as a point on a cube: the face, and the position on it. A buffer. */
export interface DirectionSteps {
  /** The axis of the face, 0 to 2: x, y, z. */
  axis: number;
  negative: boolean;
  /** The other two components, in order, divided by that of the axis. */
  a: number;
  b: number;
}

export const makeDirectionSteps = (): DirectionSteps => ({ axis: 0, negative: false, a: 0, b: 0 });

export function toDirectionSteps(
  { x, y, z }: Vec3,
  bits: number,
  target: DirectionSteps = makeDirectionSteps(),
): DirectionSteps {
  let axis = 0;
  let most = x;
  if (Math.abs(y) > Math.abs(most)) [axis, most] = [1, y];
  if (Math.abs(z) > Math.abs(most)) [axis, most] = [2, z];
  const size = Math.abs(most) || 1;
  target.axis = axis;
  target.negative = most < 0;
  target.a = toStep(axis === 0 ? y : x, size, bits);
  target.b = toStep(axis === 2 ? y : z, size, bits);
  return target;
}

/** Writes the unit vector through that point of the cube; `axis` must be 0 to 2. */
export function fromDirectionSteps(
  { axis, negative, a, b }: DirectionSteps,
  bits: number,
  target: MutableVec3 = vec3(0, 0, 0),
): MutableVec3 {
  const face = negative ? -1 : 1;
  const first = fromStep(a, 1, bits);
  const second = fromStep(b, 1, bits);
  if (axis === 0) setVec3(target, face, first, second);
  else if (axis === 1) setVec3(target, first, face, second);
  else setVec3(target, first, second, face);
  return normalise(target, undefined, target);
}

export function writeDirection(writer: BitWriter, { axis, negative, a, b }: DirectionSteps, bits: number): void {
  writer.write(axis, 2);
  writer.write(negative ? 1 : 0, 1);
  writeStep(writer, a, bits);
  writeStep(writer, b, bits);
}

export function readDirection(
  reader: BitReader,
  bits: number,
  target: DirectionSteps = makeDirectionSteps(),
): DirectionSteps | null {
  target.axis = reader.read(2);
  target.negative = reader.read(1) === 1;
  const a = readStep(reader, bits);
  const b = readStep(reader, bits);
  if (target.axis === 3 || a === null || b === null) return null;
  target.a = a;
  target.b = b;
  return target;
}

/** Writes two unit vectors that form a right-handed frame with `axis`, a unit vector. */
export function perpendicularAxes(axis: Vec3, u: MutableVec3, v: MutableVec3): void {
  if (Math.abs(axis.y) < 0.9) setVec3(u, axis.z, 0, -axis.x);
  else setVec3(u, 0, -axis.z, axis.y);
  cross(axis, normalise(u, undefined, u), v);
}
