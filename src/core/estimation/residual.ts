import type { Calibration } from '../body/calibration';
import { estimatedJoints } from '../body/joints';
import { type ChestSpaceBody, chestSpaceBody } from '../body/skeleton';
import { smoothingFactor } from '../math/damper';
import { transformPoint } from '../math/pose';
import { add, copyVec3, lerp, scale, setVec3 } from '../math/vec3';
import { chestFeatureCount, chestFeatures, headingFromChest } from './chest-features';
import { FeatureWindow, featureCount, frameFeatures } from './features';
import { type JointSmoothing, usualSmoothing } from './filter-joints';
import { copyJoints, type MutableJointPositions, makeJoints } from './joint-positions';
import type { JointNetwork, JointSource, SolvedFrame } from './joint-source';
import { LatestResult } from './latest-result';
import type { PoseRegressor } from './pose-regressor';
import { makeChestAxes } from './solve-ik';

/** Half-life [s] of the correction where the contract states none. */
const defaultHalfLife = 0.04;

/**
 * Minimum interval between inferences [s]; the correction's half-life is longer. More often doubles CPU time for 0.1–0.4 % less error
 * (docs/decisions.md). At least 2 ms from any multiple of the frame times of 60, 72, 80, 90 (every second frame) and 120 Hz (every third),
 * so the choice of frames does not depend on timing noise. At 100 Hz it is exactly two frames: there noise decides between two and three.
 */
const inferenceInterval = 0.02;

/** Numbers of the network's input: the features at each age, and the newest frame's chest-frame features. */
export const learnedInputCount = (windowSeconds: readonly number[]): number =>
  windowSeconds.length * featureCount + chestFeatureCount;

/**
 * The corrected trunk moves more than IK's, where people crouch and lie most of all: a little more smoothing, and its jerk is no more than that of IK,
 * at 0.5 to 1.2 % more error (docs/decisions.md).
 */
const residualSmoothing: JointSmoothing = { arms: 0.02, trunk: 0.035, head: 0.045 };

/**
 * Our network: the residual of the IK solution, seen from the chest of the frame it was asked about. It is damped in the heading frame
 * and added to the IK of the current frame, so that neither the filter nor a late answer delays what follows head and hands.
 */
class Residual implements JointSource, JointNetwork {
  readonly #regressor: PoseRegressor;
  readonly #window: FeatureWindow;
  readonly #input: Float32Array;
  readonly #seen = { left: false, right: false };
  /** The chest that the open question was asked from. */
  readonly #askedFrom = makeChestAxes();
  /** The newest residual, and its course after one low-pass and after both [m], heading frame. */
  readonly #newest = makeJoints();
  readonly #approached = makeJoints();
  readonly #damped = makeJoints();
  readonly #answered = makeJoints();
  readonly #inference: LatestResult;
  #body: ChestSpaceBody;
  /** Whether `newest` is an answer. */
  #known = false;
  /** Time of the frame that was asked about last [s]. */
  #askedAt = Number.NEGATIVE_INFINITY;

  constructor(calibration: Calibration, regressor: PoseRegressor) {
    const { windowSeconds } = regressor.contract;
    this.#regressor = regressor;
    this.#body = chestSpaceBody(calibration);
    this.#window = new FeatureWindow(Math.max(...windowSeconds));
    this.#input = new Float32Array(learnedInputCount(windowSeconds));
    this.#inference = new LatestResult(
      regressor,
      (output) => this.#learn(output),
      () => this.#forget(),
    );
  }

  /** IK's own while it stands alone. */
  get smoothing(): JointSmoothing {
    return this.#known ? residualSmoothing : usualSmoothing;
  }

  get network(): JointNetwork {
    return this;
  }

  get fault(): string | null {
    return this.#inference.fault;
  }

  calibrate(body: ChestSpaceBody): void {
    this.#body = body;
    this.reset();
  }

  reset(): void {
    this.#window.clear();
    this.#inference.reset();
    this.#forget();
    this.#askedAt = Number.NEGATIVE_INFINITY;
    copyJoints(nothing, this.#approached);
    copyJoints(nothing, this.#damped);
  }

  wantsFrame(time: number): boolean {
    return this.#regressor.runNow === undefined && this.#isDue(time);
  }

  ask(solved: SolvedFrame): Promise<void> {
    this.#remember(solved);
    if (this.#inference.running) return this.#inference.running;
    this.#fillInput(solved);
    return this.#inference.start(this.#input);
  }

  answer({ ik, floorFromHeading }: SolvedFrame): MutableJointPositions | null {
    if (!this.#known) return null;
    const answered = this.#answered;
    for (const joint of estimatedJoints) {
      transformPoint(floorFromHeading, add(ik.joints[joint], this.#newest[joint], answered[joint]), answered[joint]);
    }
    return answered;
  }

  joints(solved: SolvedFrame, deltaSeconds: number, target: MutableJointPositions): void {
    const { contract } = this.#regressor;
    if (this.#regressor.runNow && this.#isDue(solved.time)) {
      this.#remember(solved);
      this.#fillInput(solved);
      this.#inference.answerNow(this.#input);
    }
    const { ik, floorFromHeading } = solved;
    // Without an answer IK stands alone, and what was there fades. Two low-passes of half the half-life are as late as one, and make no corner
    // in a joint's course where an answer comes.
    const share = smoothingFactor((contract.correctionHalfLife ?? defaultHalfLife) / 2, deltaSeconds);
    for (let index = 0; index < estimatedJoints.length; index++) {
      const joint = estimatedJoints[index]!;
      const approached = lerp(this.#approached[joint], this.#newest[joint], share, this.#approached[joint]);
      const residual = lerp(this.#damped[joint], approached, share, this.#damped[joint]);
      transformPoint(floorFromHeading, add(ik.joints[joint], residual, target[joint]), target[joint]);
    }
  }

  #isDue(time: number): boolean {
    return time - this.#askedAt >= inferenceInterval;
  }

  /** Takes a frame that is asked about into the window. */
  #remember({ time, completed, points, ik }: SolvedFrame): void {
    this.#askedAt = time;
    const seen = this.#seen;
    seen.left = completed.leftHand.source === 'tracked';
    seen.right = completed.rightHand.source === 'tracked';
    frameFeatures(points, seen, ik.joints, this.#body, this.#window.push(time));
  }

  /** Writes the network's input for the newest frame, and remembers the chest from which it asks. */
  #fillInput({ points, ik }: SolvedFrame): void {
    const input = this.#input;
    const { windowSeconds } = this.#regressor.contract;
    this.#window.read(windowSeconds, input);
    chestFeatures(points, ik, this.#body, input, windowSeconds.length * featureCount);
    copyVec3(ik.chest.x, this.#askedFrom.x);
    copyVec3(ik.chest.y, this.#askedFrom.y);
    copyVec3(ik.chest.z, this.#askedFrom.z);
  }

  #learn(output: Float32Array): void {
    for (let index = 0; index < estimatedJoints.length; index++) {
      const residual = this.#newest[estimatedJoints[index]!];
      setVec3(residual, output[3 * index]!, output[3 * index + 1]!, output[3 * index + 2]!);
      scale(headingFromChest(this.#askedFrom, residual, residual), this.#body.eyeHeight, residual);
    }
    this.#known = true;
  }

  #forget(): void {
    copyJoints(nothing, this.#newest);
    this.#known = false;
  }
}

export const createResidual = (calibration: Calibration, regressor: PoseRegressor): JointSource =>
  new Residual(calibration, regressor);

const nothing = makeJoints();
