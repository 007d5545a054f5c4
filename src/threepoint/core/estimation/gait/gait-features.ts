import { unwrapAngle } from '../../math/angle';
import type { Pose } from '../../math/pose';
import { type Quat, rotate } from '../../math/quat';
import { addScaled, forward, scale, up, type Vec3, vec3, writeVec3 } from '../../math/vec3';
import { yawOf } from '../../tracking/heading';
import { FeatureWindow } from '../networks/feature-window';

/** The points of a drawn body that a gait is estimated from, floor frame [m]. */
export interface GaitPoints {
  readonly hips: Pose<'floor'>;
  readonly head: Pose<'floor'>;
  readonly leftHand: Vec3;
  readonly rightHand: Vec3;
}

/** The ages [s] of the frames that a gait is estimated from: a step takes half a second. */
const gaitAges = [0, 0.1, 0.2, 0.35, 0.5, 0.75, 1] as const;

/** The columns of a sample: hips, yaw of hips, head, yaw of head, left hand, right hand. */
const sampleWidth = 14;
const [hipsAt, hipsYawAt, headAt, headYawAt, leftAt, rightAt] = [0, 3, 4, 7, 8, 11] as const;
/** The number of features of each age in the network's input: both yaws are a sine and a cosine. */
const ageWidth = 16;
export const gaitFeatureCount = gaitAges.length * ageWidth;

const ahead = vec3(0, 0, 0);
const overhead = vec3(0, 0, 0);
const way = vec3(0, 0, 0);

/**
 * Returns the yaw of hips [rad, 0 = −Z] from a weighted sum of their forward and up axes, so that it stays defined when
 * bent over. Upside down with forward not below the horizon both weights are 0: the result is then 0 or ±π, by the
 * signs of zeros.
 */
export function yawOfHips(orientation: Quat): number {
  rotate(orientation, forward, ahead);
  rotate(orientation, up, overhead);
  scale(ahead, Math.max(0, overhead.y), way);
  addScaled(way, overhead, Math.max(0, -ahead.y), way);
  return Math.atan2(-way.x, -way.z);
}

/**
 * The inputs of a gait network: hips, head and hands at each age, in eye heights, in the frame of the current hips
 * (origin on the floor under them, their yaw).
 */
export class GaitFeatures {
  readonly values = new Float64Array(gaitFeatureCount);
  /** The features of the mirrored person. */
  readonly mirrored = new Float64Array(gaitFeatureCount);
  readonly #window = new FeatureWindow(gaitAges.at(-1)!, sampleWidth);
  readonly #samples = new Float32Array(gaitAges.length * sampleWidth);
  #hipsYaw = 0;
  #headYaw = 0;

  /** Adds a frame at a time [s] that must not decrease, and writes all ages. `eyeHeight`: [m]. */
  update({ hips, head, leftHand, rightHand }: GaitPoints, eyeHeight: number, time: number): void {
    this.#hipsYaw = unwrapAngle(yawOfHips(hips.orientation), this.#hipsYaw);
    this.#headYaw = unwrapAngle(yawOf(head.orientation), this.#headYaw);
    const sample = this.#window.push(time);
    writeVec3(hips.position, sample, hipsAt);
    sample[hipsYawAt] = this.#hipsYaw;
    writeVec3(head.position, sample, headAt);
    sample[headYawAt] = this.#headYaw;
    writeVec3(leftHand, sample, leftAt);
    writeVec3(rightHand, sample, rightAt);
    this.#window.read(gaitAges, this.#samples);
    for (let age = 0; age < gaitAges.length; age++) this.#writeAge(age, hips.position, eyeHeight);
  }

  /** Resets the history: the person was moved. */
  reset(): void {
    this.#window.clear();
  }

  #writeAge(age: number, origin: Vec3, eyeHeight: number): void {
    const samples = this.#samples;
    const from = age * sampleWidth;
    const to = age * ageWidth;
    this.#writeFromHips(to, from + hipsAt, origin, eyeHeight);
    this.#writeYaw(to + 3, samples[from + hipsYawAt]! - this.#hipsYaw);
    this.#writeFromHips(to + 5, from + headAt, origin, eyeHeight);
    this.#writeYaw(to + 8, samples[from + headYawAt]! - this.#hipsYaw);
    this.#writeFromHips(to + 10, from + leftAt, origin, eyeHeight, to + 13);
    this.#writeFromHips(to + 13, from + rightAt, origin, eyeHeight, to + 10);
  }

  /** Writes a point relative to the hips. `mirrorTo`: the index of the mirrored person's point. */
  #writeFromHips(to: number, from: number, origin: Vec3, eyeHeight: number, mirrorTo = to): void {
    const { values, mirrored } = this;
    const samples = this.#samples;
    const x = samples[from]! - origin.x;
    const z = samples[from + 2]! - origin.z;
    const c = Math.cos(this.#hipsYaw);
    const s = Math.sin(this.#hipsYaw);
    values[to] = (c * x - s * z) / eyeHeight;
    values[to + 1] = samples[from + 1]! / eyeHeight;
    values[to + 2] = (s * x + c * z) / eyeHeight;
    mirrored[mirrorTo] = -values[to]!;
    mirrored[mirrorTo + 1] = values[to + 1]!;
    mirrored[mirrorTo + 2] = values[to + 2]!;
  }

  #writeYaw(to: number, yaw: number): void {
    this.values[to] = Math.sin(yaw);
    this.values[to + 1] = Math.cos(yaw) - 1;
    this.mirrored[to] = -this.values[to]!;
    this.mirrored[to + 1] = this.values[to + 1]!;
  }
}
