import type { BoneName } from '../humanoid/bones';
import { conjugate, fromAxes, fromAxisAngle, type Quat, quat } from '../math/quat';
import { sides } from '../math/side';
import { median } from '../math/statistics';
import { add, cross, dot, length, normalise, reject, scale, subtract, type Vec3, zero } from '../math/vec3';
import { createSkeletonPose, type ImportedMotion } from '../motion/imported-motion';
import { recordOf } from '../records';
import { directions } from './read-skeleton-map';
import type { FileAxis } from './skeleton-map';

/** The joints of a body by their index in a file; absent: the file has no such joint. */
export type BodyJoints = Readonly<Partial<Record<BoneName, number>> & Record<'hips' | 'neck', number>>;

/** The cosine to the vertical above which a trunk stands. */
export const standing = 0.7;
/** The largest number of frames that are sampled to find how a clip stands. */
const maxSamples = 300;

export const axisNames = Object.keys(directions) as FileAxis[];

/** Returns the rotation to the floor frame of a file in which these axes point up and ahead. */
export const floorFromAxes = (above: Vec3, ahead: Vec3): Quat =>
  conjugate(fromAxes(cross(ahead, above), above, scale(ahead, -1)));

/** Returns the unit direction from hips to neck. */
export const trunkDirection = (positions: readonly Vec3[], { hips, neck }: BodyJoints): Vec3 =>
  normalise(subtract(positions[neck]!, positions[hips]!), zero);

/**
 * Returns the rotation to the floor frame of axes in which a body with this vertical faces −Z; null: left and right lie
 * on each other.
 */
export function bodyFloor(positions: readonly Vec3[], joints: BodyJoints, above: Vec3): Quat | null {
  const across = { x: 0, y: 0, z: 0 };
  for (const part of ['UpperLeg', 'UpperArm'] as const) {
    const [left, other] = [joints[`left${part}`], joints[`right${part}`]];
    if (left === undefined || other === undefined) continue;
    add(across, normalise(reject(subtract(positions[other]!, positions[left]!), above), zero), across);
  }
  return length(across) > 0.1 ? floorFromAxes(above, cross(above, normalise(across, zero))) : null;
}

/** Yields some frames of a clip, evenly. */
export function* sampledFrames(frameCount: number, most = maxSamples): Generator<number> {
  const step = Math.max(1, Math.ceil(frameCount / most));
  for (let frame = 0; frame < frameCount; frame += step) yield frame;
}

/** The statistics of a clip along an axis of its file. */
interface Stance {
  /** The fraction of frames in which the trunk stands along the axis, feet below the hips. */
  readonly stands: number;
  /** The fraction of frames in which trunk and legs stand upright. */
  readonly upright: number;
  /** The median of the lowest joint, as a fraction of the trunk's length. */
  readonly lowest: number;
}

function stancesOf(file: ImportedMotion, joints: BodyJoints): Readonly<Record<FileAxis, Stance>> {
  const poses = createSkeletonPose(file.names.length);
  const counts = recordOf(axisNames, () => ({ stands: 0, upright: 0, lows: [] as number[] }));
  const feet = sides.flatMap((side) => joints[`${side}Foot`] ?? []);
  const limbs = sides.flatMap((side) => [joints[`${side}UpperArm`] ?? [], joints[`${side}UpperLeg`] ?? []].flat());
  const bodies = [joints.hips, joints.neck, ...limbs, ...feet];
  for (const frame of sampledFrames(file.frameCount)) {
    const { positions } = file.pose(frame, poses);
    const trunk = subtract(positions[joints.neck]!, positions[joints.hips]!);
    const way = normalise(trunk, zero);
    const legs = feet.map((foot) => normalise(subtract(positions[foot]!, positions[joints.hips]!), zero));
    for (const axis of axisNames) {
      const above = directions[axis];
      const at = counts[axis];
      const stands = dot(way, above) > standing;
      if (stands && legs.every((leg) => dot(leg, above) < 0)) at.stands += 1;
      if (stands && legs.every((leg) => dot(leg, above) < -0.5)) at.upright += 1;
      at.lows.push(Math.min(...bodies.map((joint) => dot(positions[joint]!, above))) / length(trunk));
    }
  }
  return recordOf(axisNames, (axis) => {
    const { stands, upright, lows } = counts[axis];
    return { stands: stands / lows.length, upright: upright / lows.length, lowest: median(lows) };
  });
}

/** Returns the axis along which a body stands at rest; null: it does not stand. */
export function upAtRest(rest: readonly Vec3[], joints: BodyJoints): FileAxis | null {
  const trunk = trunkDirection(rest, joints);
  const feet = sides.flatMap((side) => joints[`${side}Foot`] ?? []);
  const below = feet.every(
    (foot) => dot(normalise(subtract(rest[foot]!, rest[joints.hips]!), zero), trunk) < -standing,
  );
  return (below && axisNames.find((axis) => dot(directions[axis], trunk) > 0.8)) || null;
}

/**
 * Returns the axis of a file that points up: that along which the body stands in most frames, else the one at rest. A
 * body that lies on the floor, and whose feet would not be on the other floor, lies.
 */
export function upOfMotion(file: ImportedMotion, joints: BodyJoints): FileAxis {
  const stances = stancesOf(file, joints);
  const rest = upAtRest(file.rest, joints) ?? '+y';
  const best = axisNames.reduce((a, b) => (stances[b].stands > stances[a].stands ? b : a));
  // A person who also stands at times lies down in the other frames.
  if (stances[best].stands <= 0.5 || stances[rest].upright > 0.05) return rest;
  const liesOnFloor = Math.abs(stances[rest].lowest) < 0.4;
  const standsOnOther = Math.abs(stances[best].lowest) < 0.5;
  return liesOnFloor && !standsOnOther ? rest : best;
}

/** Returns the rotation by right angles that takes an axis to another one. */
export function turnBetween(from: FileAxis, to: FileAxis): Quat {
  const [before, after] = [directions[from], directions[to]];
  const cosine = dot(before, after);
  if (cosine > 0.5) return quat(0, 0, 0, 1);
  const about = cosine < -0.5 ? directions[from[1] === 'z' ? '+x' : '+z'] : cross(before, after);
  return fromAxisAngle(about, cosine < -0.5 ? Math.PI : Math.PI / 2);
}

/** The rotation to the floor frame of a file with +Y up whose people face +Z. */
export const defaultFloor = floorFromAxes(directions['+y'], directions['+z']);
