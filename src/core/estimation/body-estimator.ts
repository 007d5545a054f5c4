import type { AvatarPose } from '../body/avatar-pose';
import type { Calibration } from '../body/calibration';
import { type Skeleton, skeletonFromCalibration } from '../body/skeleton';
import { type ContinuedFrame, createHandContinuity } from '../tracking/hand-continuity';
import type { TrackingFrame } from '../tracking/tracking-frame';
import type { JointPositions } from './joint-positions';
import type { EstimatorName, PoseEstimator } from './pose-estimator';
import { emptyMemory, reconstructOrientations } from './reconstruct-orientations';
import { createSteadyJoints } from './steady-joints';

/** Where a method's six joints come from; everything else is the same for all of them. */
export interface JointSource {
  calibrate(calibration: Calibration): void;
  reset(): void;
  /** Starts what takes time; never rejects. */
  prepare(frame: ContinuedFrame): Promise<void>;
  /** The six joints [m], floor frame, finite; deltaSeconds since the last call, 0 at first. */
  joints(frame: ContinuedFrame, deltaSeconds: number): JointPositions;
  /** What the network itself said of the newest finished frame, floor frame, before any filter; null without a network. */
  rawJoints(): JointPositions | null;
  /** Why the method fell back to IK in the newest frame; null: it did not. */
  fault(): string | null;
}

/** A gap longer than this [s] is no motion: filters and memories begin anew. */
const longestGapSeconds = 0.5;

/** Lost hands continued, six joints estimated and steadied, rotations reconstructed. */
export function createBodyEstimator(name: EstimatorName, calibration: Calibration, source: JointSource): PoseEstimator {
  let current = calibration;
  let skeleton: Skeleton = skeletonFromCalibration(calibration);
  const continuity = createHandContinuity(() => current);
  const steady = createSteadyJoints();
  let memory = emptyMemory();
  let lastTime: number | null = null;
  let followed: { readonly frame: TrackingFrame; readonly continued: ContinuedFrame } | null = null;

  function reset(): void {
    continuity.reset();
    source.reset();
    steady.reset();
    memory = emptyMemory();
    lastTime = null;
    followed = null;
  }

  /** Once per frame, whoever asks first. */
  function follow(frame: TrackingFrame): ContinuedFrame {
    if (followed?.frame === frame) return followed.continued;
    if (lastTime !== null && (frame.time < lastTime || frame.time - lastTime > longestGapSeconds)) reset();
    followed = { frame, continued: continuity.follow(frame) };
    return followed.continued;
  }

  return {
    name,
    calibrate(next) {
      current = next;
      skeleton = skeletonFromCalibration(next);
      source.calibrate(next);
    },
    reset,
    prepare: (frame) => source.prepare(follow(frame)),
    estimate(frame): AvatarPose {
      const continued = follow(frame);
      const deltaSeconds = lastTime === null ? 0 : frame.time - lastTime;
      lastTime = frame.time;
      const estimated = source.joints(continued, deltaSeconds);
      const joints = steady.follow(estimated, continued.head.position, deltaSeconds);
      const body = reconstructOrientations({ ...continued, joints }, skeleton, memory, deltaSeconds);
      return { head: frame.head, leftHand: frame.leftHand, rightHand: frame.rightHand, body };
    },
    rawJoints: () => source.rawJoints(),
    fault: () => source.fault(),
  };
}
