import { sideSign } from '../body/skeleton';
import type { BoneName } from '../humanoid/bones';
import { angleBetween, conjugate, fromAxes, fromAxisAngle, multiply, type Quat, quat, rotate } from '../math/quat';
import { type Side, sides } from '../math/side';
import { median } from '../math/statistics';
import {
  cross,
  distance,
  dot,
  down,
  length,
  normalise,
  reject,
  right,
  scale,
  subtract,
  type Vec3,
  zero,
} from '../math/vec3';
import { createSkeletonPose, type ImportedMotion } from '../motion/imported-motion';
import { recordOf } from '../records';
import { directions } from './read-skeleton-map';
import type { FileAxis } from './skeleton-map';

/** The joints of a body by their index in a file; absent: the file has no such joint. */
export type BodyJoints = Readonly<Partial<Record<BoneName, number>> & Record<'hips' | 'neck', number>>;

/** The largest lean of a body at rest [rad]; a larger one is another pose. */
const maxLean = 0.6;
/** The cosine to the vertical above which a trunk stands. */
const standing = 0.7;
/** The largest number of frames that are sampled to find how a clip stands. */
const maxSamples = 300;

export const axisNames = Object.keys(directions) as FileAxis[];

/** Returns the rotation to the floor frame of a file in which these axes point up and ahead. */
export const floorFromAxes = (above: Vec3, ahead: Vec3): Quat =>
  conjugate(fromAxes(cross(ahead, above), above, scale(ahead, -1)));

/** All rotations that take axes to axes, with the names of up and ahead. */
const rightAngles = axisNames.flatMap((above) =>
  axisNames
    .filter((ahead) => above[1] !== ahead[1])
    .map((ahead) => ({ above, ahead, turn: floorFromAxes(directions[above], directions[ahead]) })),
);

const nearestAxis = (way: Vec3): Vec3 =>
  axisNames.map((axis) => directions[axis]).reduce((a, b) => (dot(b, way) > dot(a, way) ? b : a));

/** The rotation that takes a body at rest to the floor frame, where it stands and faces −Z. */
export interface BodyAxes {
  readonly turn: Quat;
  /** The file's axes that point up and ahead; null: no axes do. */
  readonly axes: { readonly above: FileAxis; readonly ahead: FileAxis } | null;
}

/**
 * Returns the axes of a body from its trunk at rest; null: left and right lie on each other. `turned`: the body may
 * face anywhere, as in a frame of a motion.
 */
export function axesOfTrunk(rest: readonly Vec3[], joints: BodyJoints, turned = false): BodyAxes | null {
  const above = trunkDirection(rest, joints);
  const size = distance(rest[joints.neck]!, rest[joints.hips]!);
  for (const part of ['UpperLeg', 'UpperArm'] as const) {
    const [left, other] = [joints[`left${part}`], joints[`right${part}`]];
    if (left === undefined || other === undefined) continue;
    const across = reject(subtract(rest[other]!, rest[left]!), above);
    if (!(length(across) > 0.05 * size)) continue;
    const vertical = nearestAxis(above);
    if (turned) {
      const upward = dot(vertical, above) > Math.cos(maxLean) ? vertical : above;
      const level = normalise(reject(across, upward), zero);
      return { turn: floorFromAxes(upward, cross(upward, level)), axes: null };
    }
    const exact = floorFromAxes(above, cross(above, normalise(across, zero)));
    const nearest = rightAngles.reduce((a, b) => (angleBetween(b.turn, exact) < angleBetween(a.turn, exact) ? b : a));
    return angleBetween(nearest.turn, exact) < maxLean
      ? { turn: nearest.turn, axes: { above: nearest.above, ahead: nearest.ahead } }
      : { turn: exact, axes: null };
  }
  return null;
}

/** Returns the unit direction from hips to neck. */
export const trunkDirection = (positions: readonly Vec3[], { hips, neck }: BodyJoints): Vec3 =>
  normalise(subtract(positions[neck]!, positions[hips]!), zero);

/** Yields some frames of a clip, evenly. */
export function* sampledFrames(frameCount: number, most = maxSamples): Generator<number> {
  const step = Math.max(1, Math.ceil(frameCount / most));
  for (let frame = 0; frame < frameCount; frame += step) yield frame;
}

/** The statistics of a clip that show its vertical, in floor axes of its rest pose. */
interface Stance {
  /** The fraction of frames in which the trunk stands along an axis, feet below the hips. */
  readonly fractions: Readonly<Record<FileAxis, number>>;
  /** The fraction of frames in which trunk and legs stand upright. */
  readonly upright: number;
  /** The median of the lowest joint along an axis, as a fraction of the trunk's length. */
  readonly lowest: Readonly<Record<FileAxis, number>>;
}

function stanceOf(file: ImportedMotion, floor: Quat, joints: BodyJoints): Stance {
  const poses = createSkeletonPose(file.names.length);
  const fractions = recordOf(axisNames, () => 0);
  const lows = recordOf(axisNames, (): number[] => []);
  const feet = sides.flatMap((side) => joints[`${side}Foot`] ?? []);
  const limbs = sides.flatMap((side) => [joints[`${side}UpperArm`] ?? [], joints[`${side}UpperLeg`] ?? []].flat());
  const bodies = [joints.hips, joints.neck, ...limbs, ...feet];
  let [count, upright] = [0, 0];
  for (const frame of sampledFrames(file.frameCount)) {
    file.pose(frame, poses);
    count += 1;
    const at = (joint: number): Vec3 => rotate(floor, poses.positions[joint]!);
    const places = bodies.map(at);
    const trunk = subtract(at(joints.neck), at(joints.hips));
    const size = length(trunk);
    const way = normalise(trunk, zero);
    const legs = feet.map((foot) => normalise(subtract(at(foot), at(joints.hips)), zero));
    if (way.y > standing && legs.every((leg) => leg.y < -0.5)) upright += 1;
    for (const axis of axisNames) {
      const above = directions[axis];
      if (dot(way, above) > standing && legs.every((leg) => dot(leg, above) < 0)) fractions[axis] += 1;
      lows[axis].push(Math.min(...places.map((place) => dot(place, above))) / size);
    }
  }
  for (const axis of axisNames) fractions[axis] /= count;
  const lowest = recordOf(axisNames, (axis) => median(lows[axis]));
  return { fractions, lowest, upright: upright / count };
}

/**
 * Returns the axis, in floor axes of the rest pose, along which a clip stands if that is not up: its trunk lies in most
 * frames and would stand along this axis. null: up is correct. A body that lies on the floor, and whose feet would not
 * be on the other floor, lies.
 */
export function otherUp(file: ImportedMotion, floor: Quat, joints: BodyJoints): FileAxis | null {
  const { fractions, lowest, upright } = stanceOf(file, floor, joints);
  const best = axisNames.reduce((a, b) => (fractions[b] > fractions[a] ? b : a));
  // A person who also stands at times lies down in the other frames.
  if (best === '+y' || fractions[best] <= 0.5 || upright > 0.05) return null;
  const liesOnFloor = Math.abs(lowest['+y']) < 0.4;
  const standsOnOther = Math.abs(lowest[best]) < 0.5;
  return liesOnFloor && !standsOnOther ? null : best;
}

/** Returns the rotation by right angles that takes an axis to another one. */
export function turnBetween(from: FileAxis, to: FileAxis): Quat {
  const [before, after] = [directions[from], directions[to]];
  const cosine = dot(before, after);
  if (cosine > 0.5) return quat(0, 0, 0, 1);
  const about = cosine < -0.5 ? directions[from[1] === 'z' ? '+x' : '+z'] : cross(before, after);
  return fromAxisAngle(about, cosine < -0.5 ? Math.PI : Math.PI / 2);
}

/** Returns whether toes point back in most frames: left and right are exchanged. null: no toes show it. */
export function facesBack(file: ImportedMotion, joints: BodyJoints): boolean | null {
  const { leftUpperLeg, rightUpperLeg } = joints;
  const feet = sides.flatMap((side) => {
    const [foot, toes] = [joints[`${side}Foot`], joints[`${side}Toes`]];
    return foot === undefined || toes === undefined ? [] : [{ foot, toes }];
  });
  if (leftUpperLeg === undefined || rightUpperLeg === undefined || feet.length < 2) return null;
  const poses = createSkeletonPose(file.names.length);
  let [back, clear] = [0, 0];
  for (const frame of sampledFrames(file.frameCount, 100)) {
    const { positions } = file.pose(frame, poses);
    const above = subtract(positions[joints.neck]!, positions[joints.hips]!);
    const ahead = cross(above, subtract(positions[rightUpperLeg]!, positions[leftUpperLeg]!));
    for (const { foot, toes } of feet) {
      const way = subtract(positions[toes]!, positions[foot]!);
      const cosine = dot(normalise(way, zero), normalise(ahead, zero));
      if (Math.abs(cosine) < 0.5) continue;
      clear += 1;
      if (cosine < 0) back += 1;
    }
  }
  return clear === 0 ? null : back > 0.8 * clear;
}

/** Returns the direction out of the body to a side, in a file's axes. */
export const outward = (floor: Quat, side: Side): Vec3 => rotate(conjugate(floor), scale(right, sideSign(side)));

/** Returns the downward direction in a file's axes. */
export const downward = (floor: Quat): Vec3 => rotate(conjugate(floor), down);

/** The rotation to the floor frame of a file with +Y up whose people face +Z. */
export const defaultFloor = floorFromAxes(directions['+y'], directions['+z']);

/** Returns the rotation from a file's axes to the floor where another axis of the rest's floor points up. */
export const floorOfMotion = (floor: Quat, axis: FileAxis | null): Quat =>
  axis === null ? floor : multiply(turnBetween(axis, '+y'), floor);

/** Returns the name of the file's axis that is nearest to an axis of the floor. */
export function axisIn(floor: Quat, axis: FileAxis): FileAxis {
  const way = rotate(conjugate(floor), directions[axis]);
  return axisNames.reduce((a, b) => (dot(directions[b], way) > dot(directions[a], way) ? b : a));
}
