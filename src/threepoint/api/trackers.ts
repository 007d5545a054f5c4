// "threepoint/trackers": support for trackers of hips, chest and feet; pages without trackers do not load it.
export { trackerAtJoint } from '../core/body/tracker-offsets';
export { type Pinning, pinning } from '../core/estimation/pinning';
export type { TrackerMismatch } from '../core/estimation/tracker-watch';
