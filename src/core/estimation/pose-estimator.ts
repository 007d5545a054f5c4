import type { AvatarPose } from '../body/avatar-pose';
import type { Calibration } from '../body/calibration';
import type { TrackingFrame } from '../tracking/tracking-frame';
import type { JointPositions } from './joint-positions';

export const estimatorNames = ['hands-only', 'ik', 'paper', 'learned'] as const;
export type EstimatorName = (typeof estimatorNames)[number];

/** One method of drawing a body from three points. All state belongs to the instance: one per avatar. */
export interface PoseEstimator {
  readonly name: EstimatorName;
  /** Takes effect with the next frame. */
  calibrate(calibration: Calibration): void;
  /** Forgets the past: after a recentre, a teleport or a loss of tracking. */
  reset(): void;
  /**
   * Starts what this frame needs and cannot be had at once (inference). Call it once per frame, before `estimate`.
   * Resolves when `estimate(frame)` can use it; rejects never. A caller may await it or go on without:
   * `estimate` then uses the newest finished result.
   */
  prepare(frame: TrackingFrame): Promise<void>;
  /**
   * The body at this frame, floor frame. Synchronous, never throws, never returns NaN. Head and hands are this frame's own,
   * whatever the network's age.
   */
  estimate(frame: TrackingFrame): AvatarPose;
  /** The network's own joints [m] for the newest finished frame, floor frame, before filter and kinematics; null without one. */
  rawJoints(): JointPositions | null;
  /** Why the newest frame is IK although a network should have drawn it; null: nothing is wrong. */
  fault(): string | null;
}
