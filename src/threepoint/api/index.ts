// "threepoint": a body from three tracked points, without three.js and without a DOM.

export { type AvatarPose, copyAvatarPose, type TrackedFeet, type UpperBodyPose } from '../core/body/avatar-pose';
export {
  armSpanFromFingertipSpan,
  type Calibration,
  calibrationProblem,
  defaultCalibration,
  eyeHeightFromStature,
  type GripOffset,
  type GripOffsets,
} from '../core/body/calibration';
export { forwardKinematics, type JointPoses } from '../core/body/forward-kinematics';
export type { FingerBend, FingerName, Fingers, HandShape } from '../core/body/hand-shape';
export type { JointName } from '../core/body/joints';
export { type Skeleton, skeletonFromCalibration } from '../core/body/skeleton';
export type { TrackerName, TrackerOffset, TrackerOffsets } from '../core/body/tracker-offsets';
export type { NetworkName } from '../core/estimation/estimators';
export type { ModelContract, PoseRegressor } from '../core/estimation/networks/pose-regressor';
export type { DefaultMethod as EstimatorName } from '../core/estimation/pose-estimator';
export type { Pose, TrackedPose } from '../core/math/pose';
export type { Quat } from '../core/math/quat';
export type { Side } from '../core/math/side';
export type { Vec3 } from '../core/math/vec3';
export { type DeviceBody, deviceJointNames } from '../core/tracking/device-body';
export type { GuidedCalibration } from '../core/tracking/guided-calibration';
export { initialGuidedCalibration, stepGuidedCalibration } from '../core/tracking/guided-calibration';
export { parseRecording, type Recording, writeRecording } from '../core/tracking/recording';
export type { BodyTrackers, TrackingFrame } from '../core/tracking/tracking-frame';
export type { TrackedPoint } from '../core/tracking/tracking-gate';
export { Body, type BodyOptions, type LoadNetwork } from './body';
export type { BodyEvent, BodyEvents, CalibrationSource } from './body-events';
export { type LoadLearnedOptions, loadLearned } from './load-learned';
