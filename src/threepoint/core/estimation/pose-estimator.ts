import type { AvatarPose } from '../body/avatar-pose';
import type { Calibration } from '../body/calibration';
import type { TrackingFrame } from '../tracking/tracking-frame';

/** The methods that need only three tracked points. */
export const threePointNames = ['hands-only', 'ik', 'paper', 'paper-published', 'learned'] as const;
export type ThreePointName = (typeof threePointNames)[number];

export const estimatorNames = [...threePointNames, 'device'] as const;
export type EstimatorName = (typeof estimatorNames)[number];

/** The methods of the paper, which `onnxNetworks` brings with its network. */
export type PaperMethod = 'paper' | 'paper-published';
/** The methods of every body. */
export type DefaultMethod = Exclude<EstimatorName, PaperMethod>;

/** Deferred inference for one frame. */
export interface InferenceRequest {
  /**
   * Call it after the frame is submitted and before the next `update`; if skipped, older results stay in use. Resolves
   * when the run has ended, with or without a result; never rejects.
   */
  ask(): Promise<void>;
}

/** The result of one update; the estimator owns it, and the next update overwrites it. */
export interface Estimate {
  /** The pose, floor frame. Head and hands belong to this frame, whatever the age of the network's answer. */
  readonly pose: AvatarPose;
  /**
   * The request to a network that answers later; null: the method has none, it has answered, or it was called for a
   * frame just before.
   */
  readonly request: InferenceRequest | null;
}

/** One method of estimating a body from three points. The instance owns all state: one per avatar. */
export interface PoseEstimator {
  readonly name: EstimatorName;
  /** Sets the measures from the next frame on. */
  calibrate(calibration: Calibration): void;
  /** Resets the state after a recentre, a teleport or a loss of tracking. */
  reset(): void;
  /**
   * Estimates the body of one frame of finite poses. Synchronous; never returns NaN and never waits for a network.
   * Throws only a TypeError, where the frame has trackers and the estimator was created without `pinning`.
   */
  update(frame: TrackingFrame): Estimate;
  /** Returns why inverse kinematics replaced the network in the newest frame; null: there is no fault. */
  fault(): string | null;
}
