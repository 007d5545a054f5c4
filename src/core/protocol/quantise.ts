import { clamp } from '../math/damper';
import { normaliseQuat, type Quat } from '../math/quat';
import { normalise, type Vec3, vec3 } from '../math/vec3';
import type { BitReader, BitWriter } from './bits';

/**
 * Numbers on the wire. A signed number of b bits is a step in [−m, m] with m = 2^(b−1) − 1, written as step + m: zero is exact,
 * and the code 2^b − 1 means nothing, so that whoever reads it knows that the bytes are bad.
 */
export const mostSteps = (bits: number): number => 2 ** (bits - 1) - 1;

/** The nearest step to a value of [−range, range]; beyond: the end of the range. */
export const toStep = (value: number, range: number, bits: number): number =>
  Math.round(clamp(value / range, -1, 1) * mostSteps(bits));

export const fromStep = (step: number, range: number, bits: number): number => (step / mostSteps(bits)) * range;

export const writeStep = (writer: BitWriter, step: number, bits: number): void =>
  writer.write(step + mostSteps(bits), bits);

/** The step, or null for the code that means nothing. */
export function readStep(reader: BitReader, bits: number): number | null {
  const step = reader.read(bits) - mostSteps(bits);
  return step <= mostSteps(bits) ? step : null;
}

/** A rotation as steps: which of x, y, z, w is largest (and taken as positive), and the other three in order. */
export interface QuatSteps {
  readonly largest: number;
  readonly steps: readonly [number, number, number];
}

/** The three that are not largest lie within ±1/√2. */
const range = Math.SQRT1_2;

export function toQuatSteps(q: Quat, bits: number): QuatSteps {
  const parts = [q.x, q.y, q.z, q.w];
  let largest = 3;
  for (let i = 0; i < 3; i++) if (Math.abs(parts[i]!) > Math.abs(parts[largest]!)) largest = i;
  const sign = parts[largest]! < 0 ? -1 : 1;
  const steps = parts.filter((_, i) => i !== largest).map((part) => toStep(sign * part, range, bits));
  return { largest, steps: steps as [number, number, number] };
}

export function fromQuatSteps({ largest, steps }: QuatSteps, bits: number): Quat {
  const [a, b, c] = steps.map((step) => fromStep(step, range, bits)) as [number, number, number];
  const d = Math.sqrt(Math.max(0, 1 - a * a - b * b - c * c));
  const parts = [a, b, c];
  parts.splice(largest, 0, d);
  const [x, y, z, w] = parts as [number, number, number, number];
  return normaliseQuat({ x, y, z, w });
}

export function writeQuat(writer: BitWriter, { largest, steps }: QuatSteps, bits: number): void {
  writer.write(largest, 2);
  for (const step of steps) writeStep(writer, step, bits);
}

/** The rotation; null where the fourth component would not be the largest. */
export function readQuat(reader: BitReader, bits: number): QuatSteps | null {
  const largest = reader.read(2);
  const a = readStep(reader, bits);
  const b = readStep(reader, bits);
  const c = readStep(reader, bits);
  if (a === null || b === null || c === null) return null;
  const most = mostSteps(bits);
  const squares = (a * a + b * b + c * c) / (2 * most * most);
  const others = Math.max(Math.abs(a), Math.abs(b), Math.abs(c)) / most;
  // Rounding moves each of four equal components by half a step: two steps are more than it ever takes.
  const rest = Math.sqrt(Math.max(0, 1 - squares)) * Math.SQRT2;
  return rest >= others - 4 / most ? { largest, steps: [a, b, c] } : null;
}

/** Three steps: a vector. */
export type VecSteps = readonly [number, number, number];

export function writeVec(writer: BitWriter, steps: VecSteps, bits: number): void {
  for (const step of steps) writeStep(writer, step, bits);
}

export function readVec(reader: BitReader, bits: number): VecSteps | null {
  const x = readStep(reader, bits);
  const y = readStep(reader, bits);
  const z = readStep(reader, bits);
  return x === null || y === null || z === null ? null : [x, y, z];
}

/** A direction as the place where it leaves a cube: through which face, and where on it. */
export interface DirectionSteps {
  /** 0 to 2: x, y, z. */
  readonly axis: number;
  readonly negative: boolean;
  /** The other two components against the axis's. */
  readonly steps: readonly [number, number];
}

export function toDirectionSteps({ x, y, z }: Vec3, bits: number): DirectionSteps {
  const parts = [x, y, z];
  let axis = 0;
  for (let i = 1; i < 3; i++) if (Math.abs(parts[i]!) > Math.abs(parts[axis]!)) axis = i;
  const size = Math.abs(parts[axis]!) || 1;
  const others = parts.filter((_, i) => i !== axis).map((part) => toStep(part, size, bits));
  return { axis, negative: parts[axis]! < 0, steps: others as [number, number] };
}

/** The unit vector. */
export function fromDirectionSteps({ axis, negative, steps }: DirectionSteps, bits: number): Vec3 {
  const parts = steps.map((step) => fromStep(step, 1, bits));
  parts.splice(axis, 0, negative ? -1 : 1);
  const [x, y, z] = parts as [number, number, number];
  return normalise(vec3(x, y, z));
}

export function writeDirection(writer: BitWriter, { axis, negative, steps }: DirectionSteps, bits: number): void {
  writer.write(axis, 2);
  writer.write(negative ? 1 : 0, 1);
  for (const step of steps) writeStep(writer, step, bits);
}

export function readDirection(reader: BitReader, bits: number): DirectionSteps | null {
  const axis = reader.read(2);
  const negative = reader.read(1) === 1;
  const a = readStep(reader, bits);
  const b = readStep(reader, bits);
  return axis === 3 || a === null || b === null ? null : { axis, negative, steps: [a, b] };
}

/** Two unit vectors that make a right-handed frame with a unit vector. */
export function across(axis: Vec3): readonly [Vec3, Vec3] {
  const u = normalise(Math.abs(axis.y) < 0.9 ? vec3(axis.z, 0, -axis.x) : vec3(0, -axis.z, axis.y));
  return [u, vec3(axis.y * u.z - axis.z * u.y, axis.z * u.x - axis.x * u.z, axis.x * u.y - axis.y * u.x)];
}
