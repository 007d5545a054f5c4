import { estimatedJoints } from '../../body/joints';
import type { ChestSpaceBody } from '../../body/skeleton';
import type { Pose } from '../../math/pose';
import { rotate } from '../../math/quat';
import { right, up, type Vec3, vec3, writeVec3 } from '../../math/vec3';
import type { ThreePoints } from '../ik/solve-ik';
import type { JointPositions } from '../joint-positions';

/** The number of features of a frame; their order is in docs/estimation.md. */
export const featureCount = 46;

/** Whether the device saw each hand in the frame. */
export interface SeenHands {
  readonly left: boolean;
  readonly right: boolean;
}

const axis = vec3(0, 0, 0);

/** Writes a position relative to the headset, in units of `unit` [m]. */
function writeFromHeadset(
  features: Float32Array,
  next: number,
  { x, y, z }: Vec3,
  headset: Vec3,
  unit: number,
): number {
  features[next] = (x - headset.x) / unit;
  features[next + 1] = (y - headset.y) / unit;
  features[next + 2] = (z - headset.z) / unit;
  return next + 3;
}

/** Writes the first two columns of a rotation. */
function writeColumns(features: Float32Array, start: number, { orientation }: Pose<'heading'>): number {
  const next = writeVec3(rotate(orientation, right, axis), features, start);
  return writeVec3(rotate(orientation, up, axis), features, next);
}

/** Writes one frame's features from three points and IK's joints, both in this frame's heading frame. */
export function frameFeatures(
  { head, leftHand, rightHand }: ThreePoints,
  seen: SeenHands,
  ikJoints: JointPositions,
  body: ChestSpaceBody,
  target: Float32Array = new Float32Array(featureCount),
): Float32Array {
  const headset = head.position;
  target[0] = headset.y / body.eyeHeight;
  let next = writeColumns(target, 1, head);
  next = writeFromHeadset(target, next, leftHand.position, headset, body.arm);
  next = writeColumns(target, next, leftHand);
  next = writeFromHeadset(target, next, rightHand.position, headset, body.arm);
  next = writeColumns(target, next, rightHand);
  target[next] = seen.left ? 1 : 0;
  target[next + 1] = seen.right ? 1 : 0;
  next += 2;
  for (let index = 0; index < estimatedJoints.length; index++) {
    next = writeFromHeadset(target, next, ikJoints[estimatedJoints[index]!], headset, body.eyeHeight);
  }
  target[next] = body.arm / body.eyeHeight;
  return target;
}

interface TimedFeatures {
  time: number;
  readonly features: Float32Array;
}

/** A history of features that is read at ages in seconds, so that a window means the same at 60, 72 and 120 Hz. */
export class FeatureWindow {
  /** The frames, oldest first; dropped buffers are reused. */
  readonly #frames: TimedFeatures[] = [];
  readonly #spare: TimedFeatures[] = [];
  readonly #longestAge: number;
  readonly #width: number;

  /** width: the number of features of a frame. */
  constructor(longestAgeSeconds: number, width: number = featureCount) {
    this.#longestAge = longestAgeSeconds;
    this.#width = width;
  }

  /** Returns the buffer of a new frame for its features; a time that does not advance replaces the newest frame. */
  push(time: number): Float32Array {
    const frames = this.#frames;
    const newest = frames.at(-1);
    if (newest && time < newest.time - this.#longestAge) this.clear();
    while (frames.length > 0 && frames.at(-1)!.time >= time) this.#spare.push(frames.pop()!);
    const frame = this.#spare.pop() ?? { time, features: new Float32Array(this.#width) };
    frame.time = time;
    frames.push(frame);
    // One frame beyond the longest age stays, to interpolate from.
    while (frames.length > 2 && frames[1]!.time < time - this.#longestAge) this.#spare.push(frames.shift()!);
    return frame.features;
  }

  /**
   * Writes the features at `ages` [s] before the newest frame, one after the other; linear between frames, the oldest
   * before the start.
   */
  read(ages: readonly number[], target: Float32Array): void {
    const frames = this.#frames;
    const width = this.#width;
    const newest = frames.at(-1);
    if (!newest) {
      target.fill(0, 0, ages.length * width);
      return;
    }
    for (let slot = 0; slot < ages.length; slot++) {
      const wanted = Math.max(newest.time - ages[slot]!, frames[0]!.time);
      let after = frames.length - 1;
      while (after > 0 && frames[after - 1]!.time >= wanted) after -= 1;
      const late = frames[after]!;
      const early = frames[Math.max(0, after - 1)]!;
      const gap = late.time - early.time;
      const share = gap > 0 ? (wanted - early.time) / gap : 1;
      const from = slot * width;
      for (let i = 0; i < width; i++) {
        target[from + i] = early.features[i]! * (1 - share) + late.features[i]! * share;
      }
    }
  }

  clear(): void {
    while (this.#frames.length > 0) this.#spare.push(this.#frames.pop()!);
  }
}
