// "threepoint": a body from three tracked points, without three.js and without a DOM.

export { avatarLimits, untrustedAvatarLimits } from '../avatar/file/avatar-limits';
export { sha256Base64Url } from '../avatar/file/file-hash';
export type { DownloadOptions, FileKind } from '../avatar/file/limited-download';
export { downloadLimited, fileTooLargeError } from '../avatar/file/limited-download';
export { type AvatarPose, copyAvatarPose, type TrackedFeet, type UpperBodyPose } from '../core/body/avatar-pose';
export { type Calibration, defaultCalibration } from '../core/body/calibration';
export { forwardKinematics, type JointPoses } from '../core/body/forward-kinematics';
export type { FingerBend, FingerName, Fingers, HandShape } from '../core/body/hand-shape';
export type { JointName } from '../core/body/joints';
export { type Skeleton, skeletonFromCalibration } from '../core/body/skeleton';
export type { TrackerName, TrackerOffset, TrackerOffsets } from '../core/body/tracker-offsets';
export { createEstimator, type NetworkName } from '../core/estimation/estimators';
export type { ModelContract, PoseRegressor } from '../core/estimation/networks/pose-regressor';
export type { Estimate, EstimatorName, InferenceRequest, PoseEstimator } from '../core/estimation/pose-estimator';
export type { Pose, TrackedPose } from '../core/math/pose';
export type { Quat } from '../core/math/quat';
export type { Side } from '../core/math/side';
export type { Vec3 } from '../core/math/vec3';
export { type DeviceBody, deviceJointNames } from '../core/tracking/device-body';
export type { GuidedCalibration } from '../core/tracking/guided-calibration';
export { initialGuidedCalibration, stepGuidedCalibration } from '../core/tracking/guided-calibration';
export { createPageClock, type PageClock } from '../core/tracking/page-clock';
export { parseRecording, type Recording, writeRecording } from '../core/tracking/recording';
export type { BodyTrackers, TrackingFrame } from '../core/tracking/tracking-frame';
export type { TrackedPoint } from '../core/tracking/tracking-gate';
export { Body, type BodyOptions } from './body';
export {
  type BodyCallbacks,
  type BodyEvents,
  BodySolver,
  type BodySolverOptions,
  type CalibrationSource,
} from './body-solver';
export type { InferenceProfiler } from './inference-profiler';
export { type LoadLearnedOptions, loadLearned } from './load-learned';
export { ReplayedBody, type ReplayState } from './replayed-body';
