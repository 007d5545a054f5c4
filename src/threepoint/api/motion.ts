// "threepoint/motion": exports recordings as motion files, and converts a pose to the joints of WebXR Body Tracking.

export type { Motion } from '../core/motion/motion';
export type { MotionBone } from '../core/motion/motion-bones';
export { toXRBody, type XRBodyJoints } from '../core/motion/xr-body';
export type { Replayable } from '../core/tracking/recording';
export { type ExportMotionOptions, exportMotion } from './export-motion';
export { type MotionFile, type MotionFormat, type MotionWriter, motionFormats } from './motion-file';
export type { WorkOptions, WorkProgress } from './run-work';
