import {
  type Calibration,
  createJointPoses,
  estimatedJoints,
  estimateRecording,
  forwardKinematics,
  type PoseEstimator,
  type Replayable,
  skeletonFromCalibration,
  type UpperBodyPose,
} from 'threepoint/core';
import type { TruthJoint } from 'threepoint/internal';
import { distance, type Vec3 } from 'threepoint/math';
import type { Truth } from './truth';

/** The distances between estimated and true joints [cm], in the order of `estimatedJoints`. */
export type JointErrors = Float64Array;

/** Measures the joint errors of bodies of one person, as the evaluation does. */
export class ErrorMeter {
  readonly #skeleton;
  readonly #drawn = createJointPoses();

  constructor(calibration: Calibration) {
    this.#skeleton = skeletonFromCalibration(calibration);
  }

  measure(body: UpperBodyPose, truth: Readonly<Partial<Record<TruthJoint, Vec3>>>, target: JointErrors): JointErrors {
    forwardKinematics(this.#skeleton, body, this.#drawn);
    for (let i = 0; i < estimatedJoints.length; i++) {
      const joint = estimatedJoints[i]!;
      target[i] = 100 * distance(this.#drawn[joint].position, truth[joint]!);
    }
    return target;
  }
}

export const makeJointErrors = (): JointErrors => new Float64Array(estimatedJoints.length);
export const meanOf = (errors: JointErrors): number => errors.reduce((sum, error) => sum + error, 0) / errors.length;

/**
 * Computes the mean errors of a method over a whole clip, frame by frame and with the network's result for every frame,
 * as the evaluation does. Yields the finished share [0, 1]. Throws a sentence if the method draws no body or fails.
 */
export async function* meanErrors(
  recording: Replayable,
  truth: Truth,
  estimator: PoseEstimator,
): AsyncGenerator<number, JointErrors> {
  const meter = new ErrorMeter(recording.calibration!);
  const sums = makeJointErrors();
  const errors = makeJointErrors();
  yield* estimateRecording(recording, estimator, ({ time }, { body }) => {
    if (!body) throw new Error('it draws no body');
    meter.measure(body, truth.at(time), errors);
    for (let i = 0; i < sums.length; i++) sums[i]! += errors[i]!;
  });
  return sums.map((sum) => sum / recording.frames.length);
}
