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

/** The offset of a tracker that already reports its joint: a source that sends joints instead of devices. */
export const trackerAtJoint: TrackerOffset = { position: zero, orientation: identity };

/** A tracker further from its joint than this [m] is not worn there. */
export const farthestTracker = 0.4;

/** Returns whether an offset is finite and no longer than a tracker can be from its joint. */
export const isPlausibleOffset = (offset: TrackerOffset): boolean =>
  hasParts(offset) && isFinitePose(offset) && length(offset.position) <= farthestTracker;

/** A page without types may leave parts of an offset out. */
const hasParts = ({ position, orientation }: Partial<TrackerOffset>): boolean =>
  position !== undefined && orientation !== undefined;
