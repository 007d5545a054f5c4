import { type Quat, quat, toEulerYxz } from '../math/quat';
import { type MutableVec3, scale, setVec3, type Vec3, vec3 } from '../math/vec3';
import { hipsAt, type Motion, resampleMotion, rotationAt } from './motion';
import type { MotionBone } from './motion-bones';
import { scaleProgress } from './work';

export interface BvhOptions {
  /** The unit of lengths: metres (the default) or centimetres. */
  readonly unit?: 'm' | 'cm';
  /** Frames per second; default: those the device asked for. */
  readonly rateHz?: number;
}

const degrees = 180 / Math.PI;
/** From here on [sine of the middle angle] the outer two angles turn about the same axis to within 0.006°. */
const locked = 1 - 5e-9;

/**
 * Writes the angles [rad] about x, y, z of Ry·Rx·Rz. At gimbal lock (x is a quarter turn) only the sum or difference of
 * the others is defined: y takes all of it.
 */
export function eulerYxz(q: Quat, target: MutableVec3): MutableVec3 {
  const sine = 2 * (q.x * q.w - q.y * q.z);
  if (Math.abs(sine) < locked) return toEulerYxz(q, target);
  const y = Math.atan2(2 * (q.y * q.w - q.x * q.z), 1 - 2 * (q.y * q.y + q.z * q.z));
  return setVec3(target, Math.sign(sine) * (Math.PI / 2), y, 0);
}

/** Formats a number with fixed digits, without the sign of a negative zero. */
const fixed = (value: number, digits: number): string => {
  const text = value.toFixed(digits);
  return text.startsWith('-') && Number(text) === 0 ? text.slice(1) : text;
};

const root = 'CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation';
const joint = 'CHANNELS 3 Yrotation Xrotation Zrotation';
/** The channels of a joint that is not measured: it keeps its rest. */
const unmeasured = 'CHANNELS 0';

/** Returns the lines of the hierarchy, bones indented below their parents, and the bones in their order there. */
function hierarchy(bones: readonly MotionBone[], format: (v: Vec3) => string) {
  const lines: string[] = ['HIERARCHY'];
  const order: number[] = [];
  const write = (index: number, depth: number): void => {
    const { name, parent, offset, end, measured } = bones[index]!;
    const indent = '\t'.repeat(depth);
    order.push(index);
    lines.push(`${indent}${parent < 0 ? 'ROOT' : 'JOINT'} ${name}`, `${indent}{`);
    lines.push(`${indent}\tOFFSET ${parent < 0 ? format(vec3(0, 0, 0)) : format(offset)}`);
    lines.push(`${indent}\t${parent < 0 ? root : measured ? joint : unmeasured}`);
    for (const [child, bone] of bones.entries()) if (bone.parent === index) write(child, depth + 1);
    if (end) lines.push(`${indent}\tEnd Site`, `${indent}\t{`, `${indent}\t\tOFFSET ${format(end)}`, `${indent}\t}`);
    lines.push(`${indent}}`);
  };
  write(0, 0);
  return { lines, order };
}

const framesPerStep = 64;
/** The fraction of the work that resampling takes. */
const resampling = 0.3;

/**
 * Writes the text of a BVH file, in parts: T-pose at rest facing +Z, the root at the hips, angles in the order Y, X, Z,
 * an even rate. Bones that are not measured have no channels. Yields the fraction [0, 1] that is done. Throws a
 * sentence where the rate or the unit is none.
 */
export function* writeBvh(
  motion: Motion,
  { unit = 'm', rateHz = motion.rateHz }: BvhOptions = {},
): Generator<number, readonly string[]> {
  if (unit !== 'm' && unit !== 'cm') throw new Error(`“${String(unit)}” is not a unit of a BVH file. Use m or cm.`);
  const even = yield* scaleProgress(resampleMotion(motion, rateHz), 0, resampling);
  const perMetre = unit === 'cm' ? 100 : 1;
  const digits = unit === 'cm' ? 4 : 6;
  const place = vec3(0, 0, 0);
  const format = (v: Vec3): string => {
    const { x, y, z } = scale(v, perMetre, place);
    return `${fixed(x, digits)} ${fixed(y, digits)} ${fixed(z, digits)}`;
  };
  const count = even.times.length;
  const { lines: skeleton, order } = hierarchy(even.bones, format);
  const header = [...skeleton, 'MOTION', `Frames: ${count}`];
  const parts = [`${header.join('\n')}\nFrame Time: ${(1 / rateHz).toFixed(9)}\n`];
  const measured = order.filter((index) => even.bones[index]!.measured);
  const rotation = quat(0, 0, 0, 1);
  const angles = vec3(0, 0, 0);
  let lines = '';
  for (let frame = 0; frame < count; frame++) {
    const numbers = [format(hipsAt(even, frame, vec3(0, 0, 0)))];
    for (const bone of measured) {
      const { x, y, z } = eulerYxz(rotationAt(even, frame, bone, rotation), angles);
      numbers.push(`${fixed(y * degrees, 5)} ${fixed(x * degrees, 5)} ${fixed(z * degrees, 5)}`);
    }
    lines += `${numbers.join(' ')}\n`;
    if (frame % framesPerStep !== framesPerStep - 1) continue;
    parts.push(lines);
    lines = '';
    yield resampling + ((1 - resampling) * frame) / count;
  }
  parts.push(lines);
  return parts;
}
