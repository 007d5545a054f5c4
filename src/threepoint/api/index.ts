// "threepoint": a body from three tracked points, without three.js and without a DOM.

export { avatarLimits, untrustedAvatarLimits } from '../avatar/file/avatar-limits';
export { sha256Base64Url } from '../avatar/file/file-hash';
export type { DownloadOptions, FileKind } from '../avatar/file/limited-download';
export { downloadLimited, fileTooLargeError } from '../avatar/file/limited-download';
export type { AvatarPose, TrackedFeet, UpperBodyPose } from '../core/body/avatar-pose';
export { copyAvatarPose } from '../core/body/avatar-pose';
export type { Calibration } from '../core/body/calibration';
export {
  armSpanFromFingertipSpan,
  calibrationFromHeadHeight,
  calibrationProblem,
  defaultCalibration,
  eyeHeightFromStature,
} from '../core/body/calibration';
export type { JointPoses } from '../core/body/forward-kinematics';
export { createJointPoses, forwardKinematics } from '../core/body/forward-kinematics';
export type { FingerBend, FingerName, Fingers, HandShape } from '../core/body/hand-shape';
export type { JointName } from '../core/body/joints';
export { jointNames } from '../core/body/joints';
export type { Skeleton } from '../core/body/skeleton';
export type { TrackerName, TrackerOffset, TrackerOffsets } from '../core/body/tracker-offsets';
export type { NetworkName } from '../core/estimation/estimators';
export type { ModelContract, PoseRegressor } from '../core/estimation/networks/pose-regressor';
export type { Estimate, EstimatorName, InferenceRequest, PoseEstimator } from '../core/estimation/pose-estimator';
export { estimatorNames } from '../core/estimation/pose-estimator';
export type { Pose, TrackedPose } from '../core/math/pose';
export type { Quat } from '../core/math/quat';
export type { Side } from '../core/math/side';
export type { Vec3 } from '../core/math/vec3';
export type { DeviceBody } from '../core/tracking/device-body';
export { deviceJointNames } from '../core/tracking/device-body';
export type { GuidedCalibration } from '../core/tracking/guided-calibration';
export { initialGuidedCalibration, stepGuidedCalibration } from '../core/tracking/guided-calibration';
export type { PageClock } from '../core/tracking/page-clock';
export { createPageClock } from '../core/tracking/page-clock';
export type { Recording } from '../core/tracking/recording';
export { parseRecording, writeRecording } from '../core/tracking/recording';
export type { BodyTrackers, TrackingFrame } from '../core/tracking/tracking-frame';
export type { TrackedPoint } from '../core/tracking/tracking-gate';
export type { BodyOptions } from './body';
export { Body } from './body';
export type { BodyEvents, BodySolverOptions, CalibrationSource } from './body-solver';
export { BodySolver } from './body-solver';
export { createEstimator, skeletonFromCalibration } from './checked-calibration';
export type { InferenceProfiler } from './inference-profiler';
export type { LoadLearnedOptions } from './load-learned';
export { loadLearned } from './load-learned';
export type { ReplayState } from './replayed-body';
export { ReplayedBody } from './replayed-body';
