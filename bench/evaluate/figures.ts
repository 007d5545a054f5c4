import { recordOf } from 'threepoint/core';
import { add, cross, distance, dot, length, normalise, scale, subtract, up, type Vec3, vec3 } from 'threepoint/math';
import type { DrivenMethod } from './drive';
import { jointOf, type MeasuredFrame, rounded } from './measures';
import { type TruthJoint, truthJoints } from './recordings';

/** The six motions of the paper's figure 7. */
export const motions = ['left block', 'right block', 'sway', 'lift', 'right hand in front', 'folded arms'] as const;
export type Motion = (typeof motions)[number];

type Truth = MeasuredFrame['truth'];
type Points = Readonly<Record<TruthJoint, readonly [number, number, number]>>;

/** Axes of a person's shoulders, origin half-way between them; right-handed, −z forward, floor frame [m]. */
interface ShoulderFrame {
  readonly origin: Vec3;
  readonly right: Vec3;
  readonly forward: Vec3;
}

function shoulderFrame(truth: Truth): ShoulderFrame {
  const across = subtract(truth.rightUpperArm, truth.leftUpperArm);
  const right = normalise({ ...across, y: 0 }, vec3(1, 0, 0));
  return {
    origin: scale(add(truth.leftUpperArm, truth.rightUpperArm), 0.5),
    right,
    forward: cross(up, right),
  };
}

/** Right, up and forward of a point from the shoulders' middle [m]. */
function fromShoulders({ origin, right, forward }: ShoulderFrame, point: Vec3): Vec3 {
  const from = subtract(point, origin);
  return vec3(dot(from, right), from.y, dot(from, forward));
}

/** The wrists in each motion: right, up, forward of the shoulders' middle, in arm lengths. */
const wristsOf: Readonly<Record<Exclude<Motion, 'sway'>, { readonly left: Vec3; readonly right: Vec3 }>> = {
  'left block': { left: vec3(-0.05, 0.25, 0.5), right: vec3(0.3, -0.5, 0.2) },
  'right block': { left: vec3(-0.3, -0.5, 0.2), right: vec3(0.05, 0.25, 0.5) },
  lift: { left: vec3(-0.25, 0.75, 0.35), right: vec3(0.25, 0.75, 0.35) },
  'right hand in front': { left: vec3(-0.35, -0.8, 0.1), right: vec3(0.2, 0, 0.9) },
  'folded arms': { left: vec3(0.2, -0.4, 0.35), right: vec3(-0.2, -0.4, 0.35) },
};

/** How unlike the motion a pose is: 0 is the motion itself. Only people on their feet are asked. */
export function unlikeness(motion: Motion, truth: Truth): number {
  const frame = shoulderFrame(truth);
  const trunk = subtract(frame.origin, truth.hips);
  const sideways = dot(trunk, frame.right) / length(trunk);
  const forward = dot(trunk, frame.forward) / length(trunk);
  if (motion === 'sway') return Math.abs(Math.abs(sideways) - 0.35) * 3 + Math.abs(forward) + (trunk.y < 0 ? 9 : 0);
  const arm =
    (distance(truth.leftUpperArm, truth.leftLowerArm) +
      distance(truth.leftLowerArm, truth.leftHand) +
      distance(truth.rightUpperArm, truth.rightLowerArm) +
      distance(truth.rightLowerArm, truth.rightHand)) /
    2;
  const wanted = wristsOf[motion];
  const miss = (side: 'left' | 'right') =>
    distance(scale(fromShoulders(frame, truth[`${side}Hand`]), 1 / arm), wanted[side]);
  return miss('left') + miss('right') + 0.5 * (Math.abs(sideways) + Math.abs(forward));
}

/** One pose as every method shows it: right, up, backward of the true hips' point on the floor, facing −z [m]. */
export interface PictureOfMotion {
  readonly motion: Motion;
  readonly clip: string;
  readonly seconds: number;
  readonly unlikeness: number;
  readonly bodies: Readonly<Record<'truth', Points> & Partial<Record<DrivenMethod, Points>>>;
}

/** The picture most like each motion so far. */
export type Pictures = Map<Motion, PictureOfMotion>;

type Pictured = Readonly<
  Record<'ik', readonly MeasuredFrame[]> & Partial<Record<DrivenMethod, readonly MeasuredFrame[]>>
>;

/** Replaces each picture for which this clip has a pose more like its motion; `driven`: IK and any other methods. */
export function addPictures(pictures: Pictures, clip: string, driven: Pictured, rateHz: number): void {
  for (const motion of motions) {
    let least = pictures.get(motion)?.unlikeness ?? Number.POSITIVE_INFINITY;
    let best: number | null = null;
    for (const [row, { truth }] of driven.ik.entries()) {
      const now = unlikeness(motion, truth);
      if (!(now < least)) continue;
      least = now;
      best = row;
    }
    if (best === null) continue;
    const seconds = rounded(best / rateHz, 2);
    const bodies = bodiesAt(driven, best);
    pictures.set(motion, { motion, clip, seconds, unlikeness: rounded(least, 3), bodies });
  }
}

/** The joints of a frame as they were and as each method gives them, in the axes of `PictureOfMotion`. */
function bodiesAt(driven: Pictured, row: number): PictureOfMotion['bodies'] {
  const { truth } = driven.ik[row] as MeasuredFrame;
  const { right, forward } = shoulderFrame(truth);
  const seen = (joints: Readonly<Record<string, Vec3>>): Points =>
    recordOf(truthJoints, (name) => {
      const from = subtract(jointOf(joints, name), { ...truth.hips, y: 0 });
      return [dot(from, right), from.y, -dot(from, forward)].map((value) => rounded(value, 4));
    }) as unknown as Points;
  return {
    truth: seen(truth),
    ...Object.fromEntries(Object.entries(driven).map(([name, frames]) => [name, seen(frames[row]!.joints)])),
  };
}

/** The pictures there are, in the order of the motions. */
export const inOrder = (pictures: Pictures): readonly PictureOfMotion[] =>
  motions.flatMap((motion) => pictures.get(motion) ?? []);
