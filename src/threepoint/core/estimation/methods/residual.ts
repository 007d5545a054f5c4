import type { Calibration } from '../../body/calibration';
import { estimatedJoints } from '../../body/joints';
import { type ChestSpaceBody, chestSpaceBody } from '../../body/skeleton';
import { smoothingFactor } from '../../math/damper';
import { halfLifeOfCutoff } from '../../math/one-euro';
import { transformPoint } from '../../math/pose';
import { add, lerp, scale, setVec3 } from '../../math/vec3';
import { copyJoints, type MutableJointPositions, makeJoints } from '../joint-positions';
import type { JointNetwork, JointSource, SolvedFrame } from '../joint-source';
import { chestFeatureCount, chestFeatures, headingFromChest } from '../networks/chest-features';
import { correctionShare } from '../networks/correction-share';
import { FeatureWindow } from '../networks/feature-window';
import { featureCount, frameFeatures } from '../networks/frame-features';
import { LatestResult } from '../networks/latest-result';
import type { PoseRegressor } from '../networks/pose-regressor';
import smoothing from '../smoothing.json' with { type: 'json' };

const { correctionCutoff } = smoothing;

/** Half-life [s] of the low-pass on the correction. */
const correctionHalfLife = halfLifeOfCutoff(correctionCutoff);

/** The length of the network's input: the features at each age, and the newest frame's chest-frame features. */
export const learnedInputCount = (windowSeconds: readonly number[]): number =>
  windowSeconds.length * featureCount + chestFeatureCount;

/**
 * The learned network: the residual of the IK solution in the frame of IK's chest. It is low-passed in that frame and
 * added to the IK of the current frame, so that neither the filter nor a late result delays the motion of head, hands
 * and chest.
 */
class Residual implements JointSource, JointNetwork {
  readonly #regressor: PoseRegressor;
  readonly #window: FeatureWindow;
  readonly #input: Float32Array;
  readonly #seen = { left: false, right: false };
  /** The newest residual, zero without a result, and its low-pass [m], chest frame. */
  readonly #newest = makeJoints();
  readonly #damped = makeJoints();
  readonly #answered = makeJoints();
  readonly #inference: LatestResult;
  #body: ChestSpaceBody;

  constructor(calibration: Calibration, regressor: PoseRegressor) {
    const { windowSeconds } = regressor.contract;
    this.#regressor = regressor;
    this.#body = chestSpaceBody(calibration);
    this.#window = new FeatureWindow(Math.max(...windowSeconds));
    this.#input = new Float32Array(learnedInputCount(windowSeconds));
    this.#inference = new LatestResult(regressor);
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
    copyJoints(nothing, this.#damped);
  }

  get wantsFrames(): boolean {
    return this.#regressor.runNow === undefined;
  }

  ask(solved: SolvedFrame): Promise<void> {
    this.#addFrame(solved);
    if (this.#inference.running) return this.#inference.running;
    this.#fillInput(solved);
    return this.#inference.start(this.#input);
  }

  answer(solved: SolvedFrame): MutableJointPositions | null {
    if (!this.#inference.output) return null;
    const { ik, floorFromHeading } = solved;
    const answered = this.#answered;
    this.#readResult(solved);
    for (const joint of estimatedJoints) {
      headingFromChest(ik.chest, this.#newest[joint], answered[joint]);
      transformPoint(floorFromHeading, add(ik.joints[joint], answered[joint], answered[joint]), answered[joint]);
    }
    return answered;
  }

  joints(solved: SolvedFrame, deltaSeconds: number, target: MutableJointPositions): void {
    if (this.#regressor.runNow) {
      this.#addFrame(solved);
      this.#fillInput(solved);
      this.#inference.answerNow(this.#input);
    }
    this.#readResult(solved);
    const { ik, floorFromHeading } = solved;
    // Without a result the correction fades to zero.
    const fraction = smoothingFactor(correctionHalfLife, deltaSeconds);
    for (let index = 0; index < estimatedJoints.length; index++) {
      const joint = estimatedJoints[index]!;
      const residual = lerp(this.#damped[joint], this.#newest[joint], fraction, this.#damped[joint]);
      headingFromChest(ik.chest, residual, target[joint]);
      transformPoint(floorFromHeading, add(ik.joints[joint], target[joint], target[joint]), target[joint]);
    }
  }

  /** Adds a requested frame to the window. */
  #addFrame({ time, completed, points, ik }: SolvedFrame): void {
    const seen = this.#seen;
    seen.left = completed.leftHand.source === 'tracked';
    seen.right = completed.rightHand.source === 'tracked';
    frameFeatures(points, seen, ik.joints, this.#body, this.#window.push(time));
  }

  /** Writes the network's input for the newest frame. */
  #fillInput({ points, ik }: SolvedFrame): void {
    const input = this.#input;
    const { windowSeconds } = this.#regressor.contract;
    this.#window.read(windowSeconds, input);
    chestFeatures(points, ik, this.#body, input, windowSeconds.length * featureCount);
  }

  /** Writes the newest residual, by as much as the frame's posture allows. */
  #readResult({ points }: SolvedFrame): void {
    const { output } = this.#inference;
    if (!output) {
      copyJoints(nothing, this.#newest);
      return;
    }
    const { eyeHeight } = this.#body;
    const metres = eyeHeight * correctionShare(points.head, eyeHeight);
    for (let index = 0; index < estimatedJoints.length; index++) {
      const residual = this.#newest[estimatedJoints[index]!];
      setVec3(residual, output[3 * index]!, output[3 * index + 1]!, output[3 * index + 2]!);
      scale(residual, metres, residual);
    }
  }
}

export const createResidual = (calibration: Calibration, regressor: PoseRegressor): JointSource =>
  new Residual(calibration, regressor);

const nothing = makeJoints();
