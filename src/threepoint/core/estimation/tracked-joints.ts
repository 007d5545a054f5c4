import { type TrackerName, type TrackerOffsets, trackerNames } from '../body/tracker-offsets';
import { isTracked, type MutablePose, makePose, transformPose } from '../math/pose';
import type { BodyTrackers } from '../tracking/tracking-frame';
import { validPose } from '../tracking/tracking-gate';

/** The joints by their trackers, floor frame; null: not tracked, invalid, or without an offset. */
export type TrackedJoints = Record<TrackerName, MutablePose<'floor'> | null>;

/** The joints of the newest frame, and the buffers that they are written to. */
interface TrackedJointsState {
  readonly joints: TrackedJoints;
  readonly buffers: Readonly<Record<TrackerName, MutablePose<'floor'>>>;
}

export const makeTrackedJointsState = (): TrackedJointsState => ({
  joints: { hips: null, chest: null, leftFoot: null, rightFoot: null },
  buffers: { hips: makePose(), chest: makePose(), leftFoot: makePose(), rightFoot: makePose() },
});

/** Places the joints of a frame's trackers by their offsets. */
export function placeTrackedJoints(
  { joints, buffers }: TrackedJointsState,
  trackers: BodyTrackers | undefined,
  offsets: TrackerOffsets | undefined,
): TrackedJoints {
  for (const name of trackerNames) {
    const offset = offsets?.[name];
    const tracker = validPose(trackers?.[name]);
    joints[name] =
      offset && isTracked(tracker) ? transformPose<'floor', 'tracker'>(tracker, offset, buffers[name]) : null;
  }
  return joints;
}
