// "threepoint/webxr": requests WebXR sessions and reads their head, hands, buttons and body. It draws nothing.
export { type BoundarySize, readBoundary } from '../xr/boundary';
export { bodyFeature, DeviceBodyReader } from '../xr/device-body-reader';
export { DeviceCommands } from '../xr/device-commands';
export { drawSession, endSession } from '../xr/draw-session';
export { defaultSavings, FrameRateControl, type Savings } from '../xr/frame-rate';
export { gripFromWrist, type HandleFit, handleFit, wristFromGrip } from '../xr/grip-offsets';
export { playPulses } from '../xr/haptics';
export type { InputKind } from '../xr/input-reader';
export { Pointing } from '../xr/pointing';
export { defaultFeatures, requestPassthroughSession, requestSession, requestVrSession } from '../xr/request-session';
export { describeXrSupport, isSessionOffered, type XrFault } from '../xr/session-support';
export { TrackedSession } from '../xr/tracked-session';
