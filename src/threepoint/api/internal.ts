// "threepoint/internal": what the packages of this repository use besides the published entries. It is not published,
// and needs no three.js.
export { avatarLimits, untrustedAvatarLimits } from '../avatar/file/avatar-limits';
export { sha256Base64Url } from '../avatar/file/file-hash';
export type { DownloadOptions, FileKind } from '../avatar/file/limited-download';
export { downloadLimited, fileTooLargeError } from '../avatar/file/limited-download';
export { doubtOfErrors } from '../core/mocap/doubts';
export { isSkeletonMap } from '../core/mocap/is-skeleton-map';
export type { MocapClip, MocapSource, PreparedMocap } from '../core/mocap/prepare-mocap';
export { mocapRateHz, prepareMocap } from '../core/mocap/prepare-mocap';
export { trackedWidth } from '../core/mocap/simulate-trackers';
export { type TruthJoint, truthJoints } from '../core/mocap/skeleton-map';
export { secondsLeft } from '../core/motion/work';
export {
  bidsChannelFrames,
  bidsChannels,
  bidsMotion,
  bidsMotionSidecar,
  bidsTable,
  bidsVersion,
} from '../core/motion/write-bids';
export { type BoundarySize, readBoundary } from '../xr/boundary';
export { bodyFeature } from '../xr/device-body-reader';
export { DeviceCommands } from '../xr/device-commands';
export { drawSession, endSession } from '../xr/draw-session';
export { defaultSavings, FrameRateControl, type Savings } from '../xr/frame-rate';
export { gripDevice } from '../xr/grip-offsets';
export { playPulses } from '../xr/haptics';
export type { InputKind } from '../xr/input-reader';
export { defaultFeatures, requestPassthroughSession, requestSession, requestVrSession } from '../xr/request-session';
export { describeXrSupport, isSessionOffered, type XrFault } from '../xr/session-support';
export { emit, TypedEvents } from './event-target';
export { ReplayedBody, type ReplayState } from './replayed-body';
export { runWork } from './run-work';
