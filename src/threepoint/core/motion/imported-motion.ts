import { type MutableQuat, quat } from '../math/quat';
import { backward, type MutableVec3, right, up, type Vec3, vec3 } from '../math/vec3';

// Not in the order of a vector's fields: see `Vec3`.
/** The axes by the names that files give them. */
export const unitAxes: Readonly<Record<'x' | 'y' | 'z', Vec3>> = { z: backward, y: up, x: right };

/** The positions of a skeleton's joints, and their rotations from the rest pose, by the joint's index. */
export interface SkeletonPose {
  readonly positions: readonly MutableVec3[];
  readonly rotations: readonly MutableQuat[];
}

/** Returns a pose of `count` joints, all at the origin without rotation. */
export const createSkeletonPose = (count: number): SkeletonPose => ({
  positions: Array.from({ length: count }, () => vec3(0, 0, 0)),
  rotations: Array.from({ length: count }, () => quat(0, 0, 0, 1)),
});

/** The motion of all joints of a file of any format, in its own unit and axes. */
export interface ImportedMotion {
  readonly names: readonly string[];
  /** The parent of every joint; −1: a root. */
  readonly parents: readonly number[];
  /** The positions of all joints at rest, from the root. */
  readonly rest: readonly Vec3[];
  /** The frame rate [Hz]; null: not in the file. */
  readonly rateHz: number | null;
  readonly frameCount: number;
  /** The corrections that were made, a sentence each. */
  readonly notes: readonly string[];
  /** Writes every joint of one frame. */
  pose(frame: number, target: SkeletonPose): SkeletonPose;
}
