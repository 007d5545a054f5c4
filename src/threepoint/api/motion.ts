// "threepoint/motion": exports recordings as motion files, and converts a pose to the joints of WebXR Body Tracking.

export { doubtOfErrors } from '../core/mocap/doubts';
export { isSkeletonMap } from '../core/mocap/is-skeleton-map';
export type { MocapClip, MocapSource, PreparedMocap } from '../core/mocap/prepare-mocap';
export { mocapRateHz, prepareMocap } from '../core/mocap/prepare-mocap';
export { trackedWidth } from '../core/mocap/simulate-trackers';
export type { TruthJoint } from '../core/mocap/skeleton-map';
export { truthJoints } from '../core/mocap/skeleton-map';
export type { Motion } from '../core/motion/motion';
export type { MotionBone } from '../core/motion/motion-bones';
export { secondsLeft } from '../core/motion/work';
export {
  bidsChannelFrames,
  bidsChannels,
  bidsMotion,
  bidsMotionSidecar,
  bidsTable,
  bidsVersion,
} from '../core/motion/write-bids';
export type { XRBodyJoints } from '../core/motion/xr-body';
export { toXRBody, XRBodyPoser } from '../core/motion/xr-body';
export type { Replayable } from '../core/tracking/recording';
export type { ExportMotionOptions } from './export-motion';
export { exportMotion } from './export-motion';
export type { MotionFile, MotionFormat, MotionWriter } from './motion-file';
export { motionFormats } from './motion-file';
export type { WorkOptions, WorkProgress } from './run-work';
export { runWork } from './run-work';
