import type { Pose } from '../../math/pose';
import type { Side } from '../../math/side';
import type { Mutable } from '../../records';
import type { Tensor } from '../networks/model-weights';
import { Perceptron } from '../networks/perceptron';
import { GaitFeatures, type GaitPoints, gaitFeatureCount, yawOfHips } from './gait-features';

/**
 * The contents of a file of gait weights: its training data, and each tensor's shape and numbers
 * (training/threepoint_training/train_gait.py).
 */
export interface GaitNetwork {
  readonly trainedOn: readonly string[];
  readonly tensors: Readonly<
    Record<string, { readonly shape: readonly number[]; readonly numbers: readonly number[] }>
  >;
}

/** An expected foot, floor frame. */
export interface ExpectedFoot {
  /** The ankle on the floor plan [m]. */
  readonly x: number;
  readonly z: number;
  /** The height of the ankle over its height while the foot stands [m]. */
  readonly lift: number;
  /** The direction of the toes [rad, 0 towards −Z]. */
  readonly yaw: number;
  /** The probability that it stands [0, 1]. */
  readonly standing: number;
}

/**
 * The number of outputs: both feet relative to the hips [eye heights, their frame], logits of standing, sine and cosine
 * of each foot's yaw, and the lift of each ankle [eye heights].
 */
export const gaitOutputCount = 12;
const [standingAt, yawAt, liftAt] = [4, 6, 10] as const;

/**
 * Predicts the mean foot pose from a second of hips, head and hands; avatar/legs/stepping turns it into discrete steps.
 * A small network, computed for a person and their mirror image and averaged.
 */
export class Gait {
  readonly #own: Record<Side, Mutable<ExpectedFoot>> = {
    left: { x: 0, z: 0, lift: 0, yaw: 0, standing: 1 },
    right: { x: 0, z: 0, lift: 0, yaw: 0, standing: 1 },
  };
  /** The newest estimate; overwritten by the next update. */
  readonly feet: Readonly<Record<Side, ExpectedFoot>> = this.#own;
  readonly #features = new GaitFeatures();
  readonly #perceptron: Perceptron;

  /** Throws an Error if the weights do not belong to a gait network. */
  constructor({ tensors }: GaitNetwork) {
    const weights = new Map<string, Tensor>(
      Object.entries(tensors).map(([name, { shape, numbers }]) => [
        name,
        { shape, numbers: Float32Array.from(numbers) },
      ]),
    );
    this.#perceptron = new Perceptron(weights, 'gait', gaitFeatureCount, gaitOutputCount);
  }

  /** Adds a frame at a time [s] that must not decrease. `eyeHeight`: [m]. */
  update(points: GaitPoints, eyeHeight: number, time: number): void {
    const { values, mirrored } = this.#features;
    this.#features.update(points, eyeHeight, time);
    const { input } = this.#perceptron;
    input.set(values);
    input.set(mirrored, gaitFeatureCount);
    const outputs = this.#perceptron.run();
    const yaw = yawOfHips(points.hips.orientation);
    this.#expect(outputs, 'left', points.hips, yaw, eyeHeight);
    this.#expect(outputs, 'right', points.hips, yaw, eyeHeight);
  }

  /** Resets the history: the person was moved. */
  reset(): void {
    this.#features.reset();
  }

  #expect(outputs: Float64Array, side: Side, hips: Pose<'floor'>, yaw: number, eyeHeight: number): void {
    const foot = this.#own[side];
    const index = side === 'left' ? 0 : 1;
    const other = this.#perceptron.stride;
    const at = 2 * index;
    const mirrorAt = other + 2 * (1 - index);
    const x = ((outputs[at]! - outputs[mirrorAt]!) / 2) * eyeHeight;
    const z = ((outputs[at + 1]! + outputs[mirrorAt + 1]!) / 2) * eyeHeight;
    const c = Math.cos(yaw);
    const s = Math.sin(yaw);
    foot.x = hips.position.x + c * x + s * z;
    foot.z = hips.position.z - s * x + c * z;
    foot.lift = ((outputs[liftAt + index]! + outputs[other + liftAt + 1 - index]!) / 2) * eyeHeight;
    const logit = (outputs[standingAt + index]! + outputs[other + standingAt + 1 - index]!) / 2;
    foot.standing = 1 / (1 + Math.exp(-logit));
    const sine = outputs[yawAt + at]! - outputs[yawAt + mirrorAt]!;
    const cosine = outputs[yawAt + at + 1]! + outputs[yawAt + mirrorAt + 1]!;
    foot.yaw = yaw + Math.atan2(sine, cosine);
  }
}
