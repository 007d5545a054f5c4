import type { AvatarPose } from '../body/avatar-pose';
import type { Calibration } from '../body/calibration';
import type { TrackingFrame } from '../tracking/tracking-frame';

/** Methods that need nothing of a device but three points. */
export const threePointNames = ['hands-only', 'ik', 'paper', 'learned'] as const;
export type ThreePointName = (typeof threePointNames)[number];

export const estimatorNames = [...threePointNames, 'device'] as const;
export type EstimatorName = (typeof estimatorNames)[number];

/** The question that one frame puts to a network. */
export interface InferenceRequest {
  /**
   * Asks it, when the picture is on its way; what it answers is used from then on. Call it before the next `update` or not at
   * all: then the network goes on from older frames. Resolves when the answer is there, however it ends; rejects never.
   */
  ask(): Promise<void>;
}

/** What one frame shows, and what it wants to know. The estimator owns both and overwrites them with the next frame. */
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
