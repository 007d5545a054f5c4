import { add, type MutableVec3, setVec3, type Vec3 } from 'threepoint/math';
import type { BitReader, BitWriter } from './bit-stream';
import { placeUnit } from './quantise';

/**
 * The position of a hand relative to the head, or of an ankle relative to the hips, in 40 bits. Steps of 0.25 mm reach
 * ±1.25 m on each axis, as people do. The remaining codes have coarser steps within ±2.09 m, for controllers that are
 * put down. A buffer.
 */
export interface RelativePositionSteps {
  far: boolean;
  x: number;
  y: number;
  z: number;
}

export const makeRelativePositionSteps = (): RelativePositionSteps => ({ far: false, x: 0, y: 0, z: 0 });

interface Grid {
  /** Size of a step [m]. */
  readonly unit: number;
  /** Steps in each direction, and all steps of an axis. */
  readonly most: number;
  readonly count: number;
}

const grid = (unit: number, most: number): Grid => ({ unit, most, count: 2 * most + 1 });
const near = grid(placeUnit, 4999);
const wide = grid(0.0009, 2318);
const nearCodes = near.count ** 3;
const allCodes = nearCodes + wide.count ** 3;
/** Smaller steps on all axes belong to the finer grid. */
const minWideStep = Math.round(((near.most + 0.5) * near.unit) / wide.unit);
/** Bits of each half of a code, which is written as two numbers. */
const halfBits = 20;
const half = 2 ** halfBits;

/** Returns the nearest step; never −0, which a code cannot represent. */
const stepsOf = (along: number, { unit, most }: Grid): number =>
  Math.max(-most, Math.min(most, Math.round(along / unit))) + 0;

/** Writes the steps of a hand's position [m]; beyond ±2.09 m of the head on an axis they are clamped. */
export function toRelativePosition(head: Vec3, hand: Vec3, target: RelativePositionSteps): void {
  const x = hand.x - head.x;
  const y = hand.y - head.y;
  const z = hand.z - head.z;
  const furthest = Math.max(Math.abs(x), Math.abs(y), Math.abs(z));
  target.far = Math.round(furthest / near.unit) > near.most;
  const grid = target.far ? wide : near;
  target.x = stepsOf(x, grid);
  target.y = stepsOf(y, grid);
  target.z = stepsOf(z, grid);
}

/** Writes the hand's position into `target`, in the frame of `head` [m]. */
export function fromRelativePosition(
  head: Vec3,
  { far, x, y, z }: RelativePositionSteps,
  target: MutableVec3,
): MutableVec3 {
  const { unit } = far ? wide : near;
  return add(head, setVec3(target, x * unit, y * unit, z * unit), target);
}

/** Writes a position as 40 bits. The steps must lie within their grid, as those of `toRelativePosition` do. */
export function writeRelativePosition(writer: BitWriter, { far, x, y, z }: RelativePositionSteps): void {
  const { most, count } = far ? wide : near;
  const code = (far ? nearCodes : 0) + ((x + most) * count + (y + most)) * count + (z + most);
  writer.write(Math.floor(code / half), halfBits);
  writer.write(code % half, halfBits);
}

/** Reads a position. Returns false for an invalid code: too large, or coarse within the finer grid. */
export function readRelativePosition(reader: BitReader, target: RelativePositionSteps): boolean {
  const high = reader.read(halfBits);
  const code = high * half + reader.read(halfBits);
  if (code >= allCodes) return false;
  target.far = code >= nearCodes;
  const { most, count } = target.far ? wide : near;
  const rest = target.far ? code - nearCodes : code;
  const row = Math.floor(rest / count);
  target.z = (rest % count) - most;
  target.y = (row % count) - most;
  target.x = Math.floor(row / count) - most;
  return !target.far || Math.max(Math.abs(target.x), Math.abs(target.y), Math.abs(target.z)) >= minWideStep;
}
