import { isFinitePose, type Pose } from '../math/pose';
import { identity } from '../math/quat';
import { length, zero } from '../math/vec3';

/** The joints that a tracker beyond head and hands can pin; `leftFoot` and `rightFoot` are the ankles. */
export const trackerNames = ['hips', 'chest', 'leftFoot', 'rightFoot'] as const;
export type TrackerName = (typeof trackerNames)[number];

/** The pose of a joint in the frame of the tracker that is worn near it; a joint at rest faces −Z, +Y up. */
export type TrackerOffset = Pose<'tracker'>;

/** The offsets of the trackers that were measured. */
export type TrackerOffsets = { readonly [Name in TrackerName]?: TrackerOffset | undefined };

/** The offset for a source that reports joints instead of devices: the identity. */
export const trackerAtJoint: TrackerOffset = { position: zero, orientation: identity };

/** The largest plausible distance of a tracker from its joint [m]. */
export const maxTrackerOffset = 0.4;

/** Returns whether an offset is finite and no longer than a tracker can be from its joint. */
export const isPlausibleOffset = (offset: TrackerOffset): boolean =>
  hasParts(offset) && isFinitePose(offset) && length(offset.position) <= maxTrackerOffset;

/** A page without types may leave parts of an offset out. */
const hasParts = ({ position, orientation }: Partial<TrackerOffset>): boolean =>
  position !== undefined && orientation !== undefined;
