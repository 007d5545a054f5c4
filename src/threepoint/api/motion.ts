// "threepoint/motion": exports recordings as motion files, and converts a pose to the joints of WebXR Body Tracking.
export type { Motion } from '../core/motion/motion';
export type { MotionBone } from '../core/motion/motion-bones';
export type { XRBodyJoints } from '../core/motion/xr-body';
export { toXRBody, XRBodyPoser } from '../core/motion/xr-body';
export type { ExportMotionOptions } from './export-motion';
export { exportMotion } from './export-motion';
export type { MotionFile, MotionFormat, MotionWriter } from './motion-file';
export { motionFormats } from './motion-file';
export type { WorkOptions, WorkProgress } from './run-work';
