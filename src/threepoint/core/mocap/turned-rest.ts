import { conjugate, type Quat, quat, rotate } from '../math/quat';
import { median, quantile } from '../math/statistics';
import { parentsFirst } from '../math/tree';
import { add, dot, subtract, type Vec3, vec3 } from '../math/vec3';
import { createSkeletonPose, type ImportedMotion } from '../motion/imported-motion';
import { axisNames, type BodyJoints, sampledFrames, trunkDirection, turnBetween, upAtRest } from './body-axes';
import { directions } from './read-skeleton-map';
import type { FileAxis } from './skeleton-map';

/** The largest deviation of a root's height from that of the hips above a foot, as a fraction. */
const nearHeight = 0.2;

/**
 * Returns the axis along which the root keeps the height of the hips if that is not the axis along which the body
 * stands, at rest and in its frames; null: it is, or no axis fits.
 */
function axisOfRoot(file: ImportedMotion, joints: BodyJoints, restUp: FileAxis): FileAxis | null {
  const above = directions[restUp];
  if (joints.leftFoot === undefined) return null;
  const poses = createSkeletonPose(file.names.length);
  const places: Vec3[] = [];
  const heights: number[] = [];
  const lows: number[] = [];
  let standing = 0;
  for (const frame of sampledFrames(file.frameCount)) {
    file.pose(frame, poses);
    places.push({ ...poses.positions[joints.hips]! });
    const [hips, foot] = [joints.hips, joints.leftFoot].map((joint) => dot(poses.positions[joint]!, above));
    heights.push(hips! - foot!);
    lows.push(foot!);
    if (dot(trunkDirection(poses.positions, joints), above) > 0.7) standing += 1;
  }
  if (standing < 0.5 * places.length) return null;
  const height = median(heights);
  const along = (axis: FileAxis): readonly number[] => places.map((place) => dot(place, directions[axis]));
  const keeps = (axis: FileAxis): boolean => {
    const values = along(axis);
    const off = Math.abs(median(values) / height - 1);
    return off < nearHeight && quantile(values, 0.95) - quantile(values, 0.05) < 0.6 * height;
  };
  // Feet stand near the floor where their axis is the right one, also on stairs.
  if (keeps(restUp) || Math.abs(quantile(lows, 0.1)) < 0.7 * height) return null;
  return axisNames.find((axis) => axis !== restUp && keeps(axis)) ?? null;
}

/** Returns the motion with all offsets of its joints turned; rotations and the root's position stay. */
function withTurnedRest(file: ImportedMotion, turn: Quat): ImportedMotion {
  const { parents } = file;
  const order = parentsFirst(parents);
  const before = createSkeletonPose(file.names.length);
  const back = quat(0, 0, 0, 1);
  const offset = vec3(0, 0, 0);
  return {
    ...file,
    rest: file.rest.map((at) => rotate(turn, at)),
    pose(frame, target) {
      file.pose(frame, before);
      for (const i of order) {
        const parent = parents[i]!;
        Object.assign(target.rotations[i]!, before.rotations[i]);
        const place = target.positions[i]!;
        Object.assign(place, before.positions[i]);
        if (parent < 0) continue;
        const rotation = before.rotations[parent]!;
        subtract(before.positions[i]!, before.positions[parent]!, offset);
        rotate(turn, rotate(conjugate(rotation, back), offset, offset), offset);
        add(target.positions[parent]!, rotate(rotation, offset, offset), place);
      }
      return target;
    },
  };
}

/**
 * Returns the motion with its rest turned to the axes in which its root moves: some programs turn the offsets alone.
 * The root then keeps the height of the hips along another axis than that along which the rest stands.
 */
export function restAsMoved(file: ImportedMotion, joints: BodyJoints) {
  const rests = upAtRest(file.rest, joints);
  const above = rests && axisOfRoot(file, joints, rests);
  if (!rests || !above) return { file, notes: [] };
  const note = `its rest stands along ${rests}, its root moves with ${above} up; the rest was turned to the motion`;
  return { file: withTurnedRest(file, turnBetween(rests, above)), notes: [note] };
}
