// "threepoint/motion": exports recordings as motion files, and converts a pose to the joints of WebXR Body Tracking.

export { doubtOfErrors } from '../core/mocap/doubts';
export { isSkeletonMap } from '../core/mocap/is-skeleton-map';
export type { MocapClip, MocapSource, PreparedMocap } from '../core/mocap/prepare-mocap';
export { mocapRateHz, prepareMocap } from '../core/mocap/prepare-mocap';
export { trackedWidth } from '../core/mocap/simulate-trackers';
export { type TruthJoint, truthJoints } from '../core/mocap/skeleton-map';
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
export { toXRBody, type XRBodyJoints, XRBodyPoser } from '../core/motion/xr-body';
export type { Replayable } from '../core/tracking/recording';
export { type ExportMotionOptions, exportMotion } from './export-motion';
export { type MotionFile, type MotionFormat, type MotionWriter, motionFormats } from './motion-file';
export { runWork, type WorkOptions, type WorkProgress } from './run-work';
