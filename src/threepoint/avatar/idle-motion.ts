import type { MutableJointPoses } from '../core/body/forward-kinematics';
import { sideSign } from '../core/body/skeleton';
import { damp } from '../core/math/damper';
import { fromAxisAngle, multiply, quat, rotate } from '../core/math/quat';
import { createRandom } from '../core/math/random';
import { sides } from '../core/math/side';
import { addScaled, backward, right, vec3 } from '../core/math/vec3';

/** The duration of a breath [s], and the fraction of it in which the chest rises. */
const breathSeconds = 4;
const inhalation = 0.42;
/** The tilt of the chest and the lift of the clavicles at full breath [rad]: about 4 mm at sternum and shoulders. */
const chestTilt = 0.03;
const clavicleLift = 0.028;

/** The largest shift of the pelvis to a side [m], and its tilt then [rad]: the hip above the loaded leg is higher. */
const widestShift = 0.008;
const pelvisTilt = 0.012;
/** The time between two shifts of the weight [s]. */
const shortestPause = 4;
const longestPause = 9;
/** The half-life of each of the two filters that smooth a shift [s]. */
const shiftHalfLife = 0.3;
/** The half-life in which the motion begins and ends [s], and the amount that is none. */
const fadeHalfLife = 0.4;
const leastAmount = 1e-3;

const turn = quat(0, 0, 0, 1);
const across = vec3(0, 0, 0);

/** Returns how far the chest has risen, 0 to 1, at a fraction of a breath. */
function breathAt(fraction: number): number {
  const half = fraction < inhalation ? fraction / inhalation / 2 : 0.5 + (fraction - inhalation) / (1 - inhalation) / 2;
  return (1 - Math.cos(2 * Math.PI * half)) / 2;
}

/** The motion of a body at rest that no tracker reports: a breath, and shifts of the weight from leg to leg. */
export class IdleMotion {
  isOn = false;
  readonly #random: () => number;
  /** How much of the motion is applied, 0 to 1. */
  #amount = 0;
  /** The part of a breath that is over, 0 to 1. */
  #breath: number;
  #untilShift = 0;
  /** The side with the weight, −1 left to 1 right: where it goes to, and its filtered values. */
  #goal = 0;
  #following = 0;
  #weight = 0;

  /** `seed`: bodies with different seeds move at different times. */
  constructor(seed: number) {
    this.#random = createRandom(seed);
    this.#breath = this.#random();
  }

  /**
   * Advances by one frame and moves pelvis, chest and clavicles of a pose, floor frame. Head, elbows and hands stay
   * where they are.
   */
  apply(joints: MutableJointPoses, deltaSeconds: number): void {
    this.#amount = damp(this.#amount, this.isOn ? 1 : 0, fadeHalfLife, deltaSeconds);
    if (!this.isOn && this.#amount < leastAmount) return;
    this.#breathe(joints, deltaSeconds);
    this.#shift(joints, deltaSeconds);
  }

  #breathe({ chest, upperChest, leftShoulder, rightShoulder }: MutableJointPoses, deltaSeconds: number): void {
    this.#breath = (this.#breath + deltaSeconds / breathSeconds) % 1;
    const raised = this.#amount * breathAt(this.#breath);
    fromAxisAngle(right, raised * chestTilt, turn);
    multiply(chest.orientation, turn, chest.orientation);
    multiply(upperChest.orientation, turn, upperChest.orientation);
    for (let i = 0; i < sides.length; i++) {
      const side = sides[i]!;
      const { orientation } = side === 'left' ? leftShoulder : rightShoulder;
      multiply(orientation, fromAxisAngle(backward, sideSign(side) * raised * clavicleLift, turn), orientation);
    }
  }

  #shift({ hips: { position, orientation } }: MutableJointPoses, deltaSeconds: number): void {
    this.#untilShift -= deltaSeconds;
    if (this.#untilShift <= 0) {
      this.#untilShift = shortestPause + this.#random() * (longestPause - shortestPause);
      // The weight goes to the other leg, and seldom all of it.
      this.#goal = (this.#goal > 0 ? -1 : 1) * (0.4 + 0.6 * this.#random());
    }
    this.#following = damp(this.#following, this.#goal, shiftHalfLife, deltaSeconds);
    this.#weight = damp(this.#weight, this.#following, shiftHalfLife, deltaSeconds);
    const weight = this.#amount * this.#weight;
    addScaled(position, rotate(orientation, right, across), weight * widestShift, position);
    multiply(orientation, fromAxisAngle(backward, weight * pelvisTilt, turn), orientation);
  }
}
