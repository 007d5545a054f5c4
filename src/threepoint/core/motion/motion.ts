import { type MutableQuat, multiply, quat, readQuat, rotate, setQuat, slerp, writeQuat } from '../math/quat';
import { add, lerp, type MutableVec3, readVec3, vec3, writeVec3 } from '../math/vec3';
import type { SkeletonPose } from './imported-motion';
import type { MotionBone } from './motion-bones';

/** A body over time, in the clip frame (motion-bones.ts), from which every motion file is written. */
export interface Motion {
  /** Every bone before its children, the measured ones first. */
  readonly bones: readonly MotionBone[];
  /** The number of measured bones. */
  readonly measured: number;
  /** The device's nominal frame rate [Hz]; `times` take precedence. */
  readonly rateHz: number;
  /** Seconds from the first frame, rising. */
  readonly times: Float64Array;
  /** The hips' positions [m]: x, y, z of each frame. */
  readonly hips: Float64Array;
  /**
   * Rotation of each measured bone against its parent, in T-pose's axes: x, y, z, w, bone after bone, frame after
   * frame.
   */
  readonly rotations: Float32Array;
  /** Whether the left (1) and the right hand (2) were seen, added up, of each frame. */
  readonly seen: Uint8Array;
}

/** Returns the buffers of a motion of these bones with `count` frames. */
export function createMotion(bones: readonly MotionBone[], count: number, rateHz: number) {
  const measured = bones.filter((bone) => bone.measured).length;
  return {
    ...{ bones, measured, rateHz },
    times: new Float64Array(count),
    hips: new Float64Array(3 * count),
    rotations: new Float32Array(4 * measured * count),
    seen: new Uint8Array(count),
  } satisfies Motion;
}

/** Returns the rotation of a measured bone relative to its parent in one frame. */
export const rotationAt = (motion: Motion, frame: number, bone: number, target: MutableQuat): MutableQuat =>
  readQuat(motion.rotations, 4 * (frame * motion.measured + bone), target);

/** Returns the hips' position in one frame [m]. */
export const hipsAt = ({ hips }: Motion, frame: number, target: MutableVec3): MutableVec3 =>
  readVec3(hips, 3 * frame, target);

/** Writes position [m] and rotation from T-pose of every bone in one frame, clip frame. */
export function poseBones(motion: Motion, frame: number, target: SkeletonPose): SkeletonPose {
  const { positions, rotations } = target;
  const { bones } = motion;
  for (let i = 0; i < bones.length; i++) {
    const { parent, offset, measured } = bones[i]!;
    const position = positions[i]!;
    const rotation = rotations[i]!;
    if (measured) rotationAt(motion, frame, i, rotation);
    else setQuat(rotation, 0, 0, 0, 1);
    if (parent < 0) hipsAt(motion, frame, position);
    else {
      add(positions[parent]!, rotate(rotations[parent]!, offset, position), position);
      multiply(rotations[parent]!, rotation, rotation);
    }
  }
  return target;
}

/** The largest number of frames of a file with an even rate: two and a half hours at 120 Hz. */
const maxFrames = 1_080_000;
const framesPerStep = 64;

/**
 * Interpolates the motion at an even rate [Hz]. Yields the fraction [0, 1] that is done. Throws a sentence where the
 * rate is invalid, or the motion would have more frames than a file can hold.
 */
export function* resampleMotion(motion: Motion, rateHz: number): Generator<number, Motion> {
  const { times } = motion;
  if (!(rateHz >= 1 && rateHz <= 1000)) throw new Error(`A rate of ${rateHz} Hz is not one from 1 to 1000.`);
  const duration = times.at(-1)!;
  const count = Math.floor(duration * rateHz + 1e-6) + 1;
  if (!(count <= maxFrames))
    throw new Error(`The motion lasts ${Math.round(duration)} s, at ${rateHz} Hz more than ${maxFrames} frames.`);
  const even = createMotion(motion.bones, count, rateHz);
  for (let frame = 0, before = 0; frame < count; frame++) {
    const time = frame / rateHz;
    even.times[frame] = time;
    while (before + 1 < times.length && times[before + 1]! <= time) before += 1;
    const after = Math.min(before + 1, times.length - 1);
    const span = times[after]! - times[before]!;
    if (frame % framesPerStep === framesPerStep - 1) yield frame / count;
    mixFrame(motion, before, after, span > 0 ? (time - times[before]!) / span : 0, { into: even, frame });
  }
  return even;
}

// Scratch of `mixFrame`: hips and one bone's rotation in the two frames that are mixed.
const hipsBefore = vec3(0, 0, 0);
const hipsAfter = vec3(0, 0, 0);
const rotationBefore = quat(0, 0, 0, 1);
const rotationAfter = quat(0, 0, 0, 1);

function mixFrame(
  motion: Motion,
  before: number,
  after: number,
  fraction: number,
  { into, frame }: { readonly into: Motion; readonly frame: number },
): void {
  const hips = lerp(hipsAt(motion, before, hipsBefore), hipsAt(motion, after, hipsAfter), fraction, hipsBefore);
  writeVec3(hips, into.hips, 3 * frame);
  for (let bone = 0; bone < motion.measured; bone++) {
    const rotation = slerp(
      rotationAt(motion, before, bone, rotationBefore),
      rotationAt(motion, after, bone, rotationAfter),
      fraction,
      rotationBefore,
    );
    writeQuat(rotation, into.rotations, 4 * (frame * motion.measured + bone));
  }
  into.seen[frame] = motion.seen[fraction < 0.5 ? before : after]!;
}
