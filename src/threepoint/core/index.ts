// "threepoint/core": bodies, calibration, kinematics, tracked input and checked values. It has no DOM, clock or chance.
export {
  alongArm,
  armBoneRotation,
  clavicleRest,
  elbowHinge,
  handBoneRotation,
  hingeAtRest,
} from './body/arm-rotations';
export type { AvatarPose, MutableUpperBodyPose, TrackedFeet, UpperBodyPose } from './body/avatar-pose';
export { makeUpperBodyPose } from './body/avatar-pose';
export { type AvatarHash, type AvatarRef, avatarHashPattern, maxAvatarBytes } from './body/avatar-ref';
export type { BuiltInAvatar, BuiltInBody, SkinTone } from './body/built-in-bodies';
export {
  bodyOf,
  builtInAvatarOf,
  builtInBodies,
  defaultAvatar,
  isBuiltInAvatar,
  skinToneOf,
  skinTones,
} from './body/built-in-bodies';
export type { Calibration, GripOffset, GripOffsets, HandleFit, MeasureRange } from './body/calibration';
export {
  armSpanFromFingertipSpan,
  armSpanRange,
  assertCalibration,
  calibrationProblem,
  defaultCalibration,
  eyeHeightFromStature,
  fingertipSpanFromArmSpan,
  forearmRange,
  handleFitParts,
  largestGripOffset,
  sameMeasures,
  statureFromEyeHeight,
  statureRange,
  withForearm,
} from './body/calibration';
export { fingerBoneSuffixes } from './body/finger-bone-names';
export { createJointPoses, forwardKinematics, type JointPoses } from './body/forward-kinematics';
export type { HandGeometry } from './body/hand-geometry';
export type { FingerName, Fingers, HandShape, MutableHandShape } from './body/hand-shape';
export { copyFingers, isFiniteHand, lerpHandShape, makeHandShape, unknownFingers } from './body/hand-shape';
export { headJointOf } from './body/head-joint';
export { type EstimatedJoint, estimatedJoints, jointNames } from './body/joints';
export { writeLocalRotations } from './body/local-rotations';
export type { PersonalAvatar, RemotePerson } from './body/remote-person';
export type { Skeleton } from './body/skeleton';
export {
  armBonesOf,
  averageSkeleton,
  chestSpaceBody,
  sideSign,
  skeletonFromCalibration,
  wristFromHandBone,
} from './body/skeleton';
export { elbowCircle, elbowFlexion, elbowOnCircle, makeElbowCircle, poleAcross } from './body/two-bone-ik';
export { firstLine, reasonOf } from './errors/reasons';
export { TransientError } from './errors/transient-error';
export { estimateRecording } from './estimation/estimate-recording';
export { createEstimator, networkOf } from './estimation/estimators';
export type { EstimatorName, PaperMethod, PoseEstimator, ThreePointName } from './estimation/pose-estimator';
export { estimatorNames, threePointNames } from './estimation/pose-estimator';
export { nameOfAddress } from './files';
export { type BoneMap, type BoneName, boneNames, neededBones, vrmFingerNames } from './humanoid/bones';
export type { SkeletonJoint } from './humanoid/joint-tree';
export { type FileBones, UnknownBonesError } from './humanoid/unknown-bones-error';
export type { Button, Buttons, HandButtons } from './input/button-presses';
export {
  allReleased,
  ButtonPresses,
  nothingPressed,
  playingHand,
  pressureOf,
  releasedBelow,
} from './input/button-presses';
export { GazePointer } from './input/gaze-pointer';
export type { HapticPulse } from './input/haptic-pulse';
export { MutablePointer, type Pointer, type PointerTarget } from './input/pointer';
export { isObject } from './json';
export { type Mutable, recordOf } from './records';
export { actorFrame } from './tracking/actor-motion';
export { type CalibrationFault, calibrationFaults } from './tracking/calibration-faults';
export { deviceJoint } from './tracking/device-body';
export { type GuidedCalibration, initialGuidedCalibration, stepGuidedCalibration } from './tracking/guided-calibration';
export { headingOf } from './tracking/heading';
export { createPageClock, maxStepSeconds, monotonic, type PageClock } from './tracking/page-clock';
export type { Recording, Replayable, TrackingFrames } from './tracking/recording';
export {
  parseRecording,
  recordingDuration,
  sampleRecording,
  writeRecording,
  writeRecordingWithin,
} from './tracking/recording';
export type { SeatAction } from './tracking/seat-action';
export { maxLatencyMs, TrackingDegradation } from './tracking/tracking-degradation';
export type { TrackingFrame } from './tracking/tracking-frame';
export {
  checked,
  complaintsAbout,
  handTiltsSchema,
  identifier,
  integerBetween,
  numberBetween,
  participantId,
  text,
  ValidationError,
} from './validation/validation';
