import { type Calibration, estimatedJoints } from 'threepoint/core';
import {
  conjugate,
  copyPose,
  multiply,
  type Pose,
  type Quat,
  right,
  rotate,
  scale,
  setVec3,
  subtract,
  transformPose,
  up,
} from 'threepoint/math';
import { armLength } from '../../src/threepoint/core/body/skeleton';
import { copyJoints, makeJoints, transformJoints } from '../../src/threepoint/core/estimation/joint-positions';
import type { JointSource, SolvedFrame } from '../../src/threepoint/core/estimation/joint-source';
import { LatestResult } from '../../src/threepoint/core/estimation/networks/latest-result';
import type { PoseRegressor } from '../../src/threepoint/core/estimation/networks/pose-regressor';
import { Pipeline } from '../../src/threepoint/core/estimation/pipeline';
import { floorFromHeading, headingFromFloor } from '../../src/threepoint/core/tracking/heading';

/** The frames of a window, and the numbers of each (training/threepoint_training/board_networks.py). */
export const windowFrames = 40;
const frameFeatures = 54;
/** The arm's length follows the frames. */
export const windowInputs = windowFrames * frameFeatures + 1;
const trackers = ['head', 'leftHand', 'rightHand'] as const;

/** Headset and hands of one frame, floor frame. */
export type TrackedPoints = Readonly<Record<(typeof trackers)[number], Pose<'floor'>>>;

/** Writes the x and y axes of a rotation. */
function writeAxes(target: Float32Array, at: number, orientation: Quat): void {
  const [x, y] = [rotate(orientation, right), rotate(orientation, up)];
  target.set([x.x, x.y, x.z, y.x, y.y, y.z], at);
}

/**
 * Returns the input of the board's networks: features of the newest 40 of these frames, oldest first, in eye heights
 * and in the heading frame of the newest; then the arm's length. Before the first frame nothing moved.
 */
export function windowFeatures(frames: readonly TrackedPoints[], calibration: Calibration): Float32Array {
  const target = new Float32Array(windowInputs);
  const toHeading = headingFromFloor(frames.at(-1)!.head);
  const inHeading = Array.from({ length: windowFrames + 1 }, (_, index) => {
    const frame = frames[Math.max(0, frames.length - 1 - windowFrames + index)]!;
    return trackers.map((tracker) => {
      const { position, orientation } = transformPose(toHeading, frame[tracker]);
      return { position: scale(position, 1 / calibration.eyeHeight), orientation };
    });
  });
  for (let index = 0; index < windowFrames; index++) {
    for (const [tracker, { position, orientation }] of inHeading[index + 1]!.entries()) {
      const before = inHeading[index]![tracker]!;
      const at = index * frameFeatures;
      const velocity = subtract(position, before.position);
      writeAxes(target, at + 6 * tracker, orientation);
      writeAxes(target, at + 18 + 6 * tracker, multiply(conjugate(before.orientation), orientation));
      target.set([position.x, position.y, position.z], at + 36 + 3 * tracker);
      target.set([velocity.x, velocity.y, velocity.z], at + 45 + 3 * tracker);
    }
  }
  target[windowInputs - 1] = armLength(calibration) / calibration.eyeHeight;
  return target;
}

/** Creates a source with a network over windows of trackers. Inverse kinematics supplies joints before its result. */
function createWindowSource(calibration: Calibration, regressor: PoseRegressor): JointSource {
  const frames: TrackedPoints[] = [];
  const answered = makeJoints();
  const inference = new LatestResult(regressor);

  /** Returns the joints of the newest result in the heading of this frame; null: there is none. */
  function answer({ completed }: SolvedFrame) {
    const { output } = inference;
    if (output === null) return null;
    const inHeading = makeJoints();
    for (const [index, joint] of estimatedJoints.entries()) {
      const [x, y, z] = output.subarray(3 * index);
      setVec3(inHeading[joint], x! * calibration.eyeHeight, y! * calibration.eyeHeight, z! * calibration.eyeHeight);
    }
    return transformJoints(floorFromHeading(completed.head), inHeading, answered);
  }

  return {
    network: {
      wantsFrames: true,
      ask: () => inference.running ?? inference.start(windowFeatures(frames, calibration)),
      answer,
      get fault() {
        return inference.fault;
      },
    },
    calibrate: () => undefined,
    reset() {
      inference.reset();
      frames.length = 0;
    },
    joints(solved, _, target) {
      const { head, leftHand, rightHand } = solved.completed;
      frames.push({ head: copyPose(head), leftHand: copyPose(leftHand), rightHand: copyPose(rightHand) });
      if (frames.length > windowFrames + 1) frames.shift();
      const joints = answer(solved);
      if (joints) copyJoints(joints, target);
      else transformJoints(solved.floorFromHeading, solved.ik.joints, target);
    },
  };
}

/** Creates an estimator with a network over windows of trackers; the stages of the page do the rest. */
export const createWithWindows = (calibration: Calibration, regressor: PoseRegressor): Pipeline =>
  new Pipeline('learned', calibration, createWindowSource(calibration, regressor));
