import type { Calibration } from '../body/calibration';
import { legProportions } from '../body/leg-proportions';
import { averageSkeleton } from '../body/skeleton';
import { isPlausibleOffset, type TrackerName, type TrackerOffset, trackerNames } from '../body/tracker-offsets';
import {
  invertTransform,
  type MutablePose,
  makePose,
  makeTransform,
  type Pose,
  transformPose,
  transformTracked,
} from '../math/pose';
import { identity, normaliseQuat, type Quat, quat } from '../math/quat';
import { add, distance, scale, subtract, type Vec3, vec3 } from '../math/vec3';
import type { Mutable } from '../records';
import type { TrackingFrame } from './tracking-frame';

/** The trackers of one frame; null or absent: not seen. */
export type TrackerSample = { readonly [Name in TrackerName]?: Pose<'heading'> | null };

/** The fraction of the frames in which a tracker must be seen. */
const seenFraction = 0.7;
/** The largest mean distance of a tracker at rest from its middle [m]. */
const trackerSway = 0.03;
/** The smallest length of the mean of its rotations, as unit quaternions: within some 15° of each other. */
const steadyRotation = 0.99;
/** A head lower than this [eye heights] is that of a person who sits, whose feet are not below the hips. */
const standingHead = 0.9;

/** Returns the trackers that a frame shows, heading frame; null: there are none. */
function sampleTrackers(
  headingFromFloor: Parameters<typeof transformTracked<'heading'>>[0],
  trackers: TrackingFrame['trackers'],
): TrackerSample | null {
  if (!trackers) return null;
  const sample: Mutable<TrackerSample> = {};
  for (const name of trackerNames) sample[name] = transformTracked(headingFromFloor, trackers[name] ?? null);
  return sample;
}

/**
 * Returns the joints in the frames of their trackers, for a person of this body who stands straight with the eyes at
 * `headHeight` [m]. Hips and chest joint are those of the body's rest pose under the head. An ankle is below the hips,
 * as far aside as its tracker, with the toes straight ahead. A tracker that moved or was lost is left out.
 */
function measureTrackers(
  samples: readonly (TrackerSample | null)[],
  calibration: Calibration,
  headHeight: number,
): Pick<Calibration, 'trackerOffsets'> {
  const offsets: { [Name in TrackerName]?: TrackerOffset } = {};
  const restJoint = restJointsOf(calibration, headHeight);
  for (const name of trackerNames) {
    const tracker = meanPose(samples.map((sample) => sample?.[name] ?? null));
    const joint = tracker && restJoint(name, tracker.position);
    if (!joint) continue;
    const trackerFromHeading = invertTransform<'heading', 'tracker'>(tracker, makeTransform());
    const offset = transformPose<'tracker', 'heading'>(trackerFromHeading, { position: joint, orientation: identity });
    if (isPlausibleOffset(offset)) offsets[name] = offset;
  }
  return Object.keys(offsets).length > 0 ? { trackerOffsets: offsets } : {};
}

/** Measures how trackers are worn, in a guided calibration. */
export const trackerMeasuring = { sample: sampleTrackers, measure: measureTrackers } as const;
export type TrackerMeasuring = typeof trackerMeasuring;

/** Returns a function for the joints of a person who stands straight, heading frame; null: unknown. */
function restJointsOf(calibration: Calibration, headHeight: number): (name: TrackerName, tracker: Vec3) => Vec3 | null {
  const { restOffsets, eyesInHead } = averageSkeleton(calibration);
  const head = subtract(vec3(0, headHeight, 0), eyesInHead);
  const neck = subtract(head, restOffsets.head);
  const chest = subtract(subtract(neck, restOffsets.neck), restOffsets.upperChest);
  const hips = subtract(subtract(chest, restOffsets.chest), restOffsets.spine);
  const stands = headHeight > standingHead * calibration.eyeHeight;
  return (name, tracker) => {
    if (name === 'hips') return hips;
    if (name === 'chest') return chest;
    return stands ? vec3(tracker.x, legProportions.ankle * calibration.eyeHeight, hips.z) : null;
  };
}

/** Returns the mean of the poses of a tracker at rest; null: it moved, or was not seen most of the time. */
function meanPose(poses: readonly (Pose<'heading'> | null)[]): MutablePose<'heading'> | null {
  const seen = poses.filter((pose) => pose !== null);
  if (seen.length === 0 || seen.length < seenFraction * poses.length) return null;
  const mean = makePose<'heading'>();
  const position = scale(
    seen.reduce((sum, pose) => add(sum, pose.position), vec3(0, 0, 0)),
    1 / seen.length,
    mean.position,
  );
  const sway = seen.reduce((sum, pose) => sum + distance(pose.position, position), 0) / seen.length;
  const rotation = seen.reduce(
    (sum, { orientation }) => addRotation(sum, orientation, 1 / seen.length),
    quat(0, 0, 0, 0),
  );
  const { x, y, z, w } = rotation;
  if (sway > trackerSway || Math.hypot(x, y, z, w) < steadyRotation) return null;
  normaliseQuat(rotation, mean.orientation);
  return mean;
}

/** Adds a fraction of a rotation to a sum; q and −q are the same rotation. */
function addRotation(sum: Quat, q: Quat, fraction: number): Quat {
  const sign = sum.x * q.x + sum.y * q.y + sum.z * q.z + sum.w * q.w < 0 ? -fraction : fraction;
  return { x: sum.x + sign * q.x, y: sum.y + sign * q.y, z: sum.z + sign * q.z, w: sum.w + sign * q.w };
}
