// "threepoint/webxr": reads head, hands and fingers of a WebXR session, for pages of any engine. It draws nothing.
export type { HandleFit } from '../core/body/calibration';
export { gripFromWrist, handleFit, wristFromGrip } from '../xr/grip-offsets';
export { Pointing } from '../xr/pointing';
export { TrackedSession } from '../xr/tracked-session';
export { TrackingReader } from '../xr/tracking-reader';
