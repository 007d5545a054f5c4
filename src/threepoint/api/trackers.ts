// "threepoint/trackers": support for trackers of hips, chest and feet; pages without trackers do not load it.
export type { TrackerName, TrackerOffset, TrackerOffsets } from '../core/body/tracker-offsets';
export { trackerAtJoint } from '../core/body/tracker-offsets';
export { type Pinning, type Pins, pinning } from '../core/estimation/pinning';
export type { TrackerMismatch } from '../core/estimation/tracker-watch';
export type { TrackerMeasuring, TrackerSample } from '../core/tracking/measure-trackers';
export type { BodyTrackers } from '../core/tracking/tracking-frame';
