import { type MutableQuat, quat } from '../math/quat';
import { type MutableVec3, type Vec3, vec3 } from '../math/vec3';

/** Positions and rotations of joints since the rest pose: of a file in its own unit and axes. */
export interface SkeletonPose {
  readonly positions: readonly MutableVec3[];
  readonly rotations: readonly MutableQuat[];
}

/** Poses of so many joints, all at the origin, as at rest. */
export const createSkeletonPose = (count: number): SkeletonPose => ({
  positions: Array.from({ length: count }, () => vec3(0, 0, 0)),
  rotations: Array.from({ length: count }, () => quat(0, 0, 0, 1)),
});

/** What a file of motion says of all joints of a skeleton, whichever format it has; in its own unit and axes. */
export interface ImportedMotion {
  readonly names: readonly string[];
  /** The parent of every joint; −1: a root. */
  readonly parents: readonly number[];
  /** The positions of all joints at rest, from the root. */
  readonly rest: readonly Vec3[];
  /** Frames per second; null: the file does not say. */
  readonly rateHz: number | null;
  readonly frameCount: number;
  /** What was put right, a sentence each. */
  readonly notes: readonly string[];
  /** Writes every joint of one frame. */
  pose(frame: number, target: SkeletonPose): SkeletonPose;
}
