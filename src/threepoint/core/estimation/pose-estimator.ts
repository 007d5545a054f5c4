import type { AvatarPose } from '../body/avatar-pose';
import type { Calibration } from '../body/calibration';
import type { TrackingFrame } from '../tracking/tracking-frame';

/** Methods that need nothing of a device but three points. */
export const threePointNames = ['hands-only', 'ik', 'paper', 'learned'] as const;
export type ThreePointName = (typeof threePointNames)[number];

export const estimatorNames = [...threePointNames, 'device'] as const;
export type EstimatorName = (typeof estimatorNames)[number];

/** Deferred inference for one frame. */
export interface InferenceRequest {
  /**
   * Call it after the frame is submitted and before the next `update`; if skipped, older results stay in use. Resolves when the run has
   * ended, with or without a result; never rejects.
   */
  ask(): Promise<void>;
}

/** Output of one update; owned by the estimator and overwritten by the next. */
export interface Estimate {
  /** Floor frame. Head and hands are of this very frame, however old the network's answer is. */
  readonly pose: AvatarPose;
  /** Null: the method has no network, or one that has answered already or was asked about a frame just before. */
  readonly request: InferenceRequest | null;
}

/** One method of drawing a body from three points. All state belongs to the instance: one per avatar. */
export interface PoseEstimator {
  readonly name: EstimatorName;
  /** Takes effect with the next frame. */
  calibrate(calibration: Calibration): void;
  /** Forgets the past: after a recentre, a teleport or a loss of tracking. */
  reset(): void;
  /** One frame, of finite poses. Synchronous; never throws, never returns NaN; waits for no network. */
  update(frame: TrackingFrame): Estimate;
  /** Why the newest frame is IK although a network should have drawn it; null: nothing is wrong. */
  fault(): string | null;
}
