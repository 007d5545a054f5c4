import { estimatedJoints, recordOf } from 'threepoint/core';
import { cross, distance, dot, normalise, reject, sides, subtract, type Vec3 } from 'threepoint/math';
import type { JointPositions } from '../../src/threepoint/core/estimation/joint-positions';
import { mean } from '../../src/threepoint/core/math/statistics';
import type { TruthJoint } from './recordings';

/** Names of the six joints in every report. */
export const reportNames = ['leftElbow', 'rightElbow', 'leftShoulder', 'rightShoulder', 'spine', 'pelvis'] as const;

export type ByJoint<Figure> = Readonly<Record<(typeof reportNames)[number], Figure>>;

export interface Spread {
  readonly mean: number;
  readonly median: number;
  readonly p95: number;
}

export interface Report {
  readonly mpjpeCm: Spread;
  readonly joints: ByJoint<Spread>;
  /** Per coordinate, over all joints and by joint. */
  readonly mseCm2: number;
  readonly maeCm: number;
  readonly jointMseCm2: ByJoint<number>;
  readonly jointMaeCm: ByJoint<number>;
  readonly swivelDeg: number;
  readonly jerkRatio: number;
  readonly boneVariationMm: number;
  readonly handErrorMm: number;
  readonly handErrorMaxMm: number;
  /** The network's own output before kinematics; absent for methods without one. */
  readonly rawMpjpeCm?: number;
}

/** An arm straighter than this [m from the elbow to the shoulder-wrist line] has no swivel to speak of. */
const straightArm = 0.03;

/** Sums over the frames of some clips [mm for hands, cm for the network's own errors]. */
const sums = ['jerk', 'truthJerk', 'handError', 'hands', 'rawError', 'rawCount'] as const;

/** What one estimator did with some clips; add clip by clip, merge people, then report. */
export interface Measures extends Record<(typeof sums)[number], number> {
  readonly errors: number[][];
  /** Sums over frames and coordinates by joint [cm², cm]. */
  readonly squares: number[];
  readonly absolutes: number[];
  readonly swivels: number[];
  boneVariation: number;
  handErrorMax: number;
}

export const emptyMeasures = (): Measures => ({
  ...recordOf(sums, () => 0),
  errors: estimatedJoints.map(() => []),
  squares: estimatedJoints.map(() => 0),
  absolutes: estimatedJoints.map(() => 0),
  swivels: [],
  boneVariation: 0,
  handErrorMax: 0,
});

/** One frame of one clip as estimated, beside its truth. Floor frame [m]. */
export interface MeasuredFrame {
  readonly joints: Readonly<Record<string, Vec3>>;
  readonly raw: JointPositions | null;
  readonly truth: Readonly<Record<TruthJoint, Vec3>>;
  /** The tracked wrists; null: unseen. */
  readonly wrists: { readonly left: Vec3 | null; readonly right: Vec3 | null };
}

/** Pairs of joints whose distance must not change. */
const bones = [
  ['leftUpperArm', 'leftLowerArm'],
  ['leftLowerArm', 'leftHand'],
  ['rightUpperArm', 'rightLowerArm'],
  ['rightLowerArm', 'rightHand'],
  ['leftShoulder', 'leftUpperArm'],
  ['rightShoulder', 'rightUpperArm'],
  ['hips', 'spine'],
  ['spine', 'chest'],
  ['chest', 'upperChest'],
  ['upperChest', 'neck'],
  ['neck', 'head'],
] as const;

/** Returns the place of a joint [m]. Throws if the estimator gave none. */
export const jointOf = (joints: Readonly<Record<string, Vec3>>, name: string): Vec3 => {
  const joint = joints[name];
  if (!joint) throw new Error(`the estimator gave no ${name}`);
  return joint;
};

/** The length of the third difference of four places, one after the other [m]. */
export function thirdDifference(a: Vec3, b: Vec3, c: Vec3, d: Vec3): number {
  const along = (axis: 'x' | 'y' | 'z') => d[axis] - 3 * c[axis] + 3 * b[axis] - a[axis];
  return Math.hypot(along('x'), along('y'), along('z'));
}

/** The signed angle (−π, π] [rad] about shoulder→wrist from one elbow to another: the error in swivel. */
export function swivelAngle(shoulder: Vec3, wrist: Vec3, elbow: Vec3, otherElbow: Vec3): number {
  const axis = normalise(subtract(wrist, shoulder));
  const from = reject(subtract(elbow, shoulder), axis);
  const to = reject(subtract(otherElbow, shoulder), axis);
  return Math.atan2(dot(cross(from, to), axis), dot(from, to));
}

/** Adds one clip's frames, in order, at `rateHz`. */
export function addClip(measures: Measures, frames: readonly MeasuredFrame[], rateHz: number): void {
  const lengths = bones.map(() => ({ least: Number.POSITIVE_INFINITY, most: 0 }));
  for (const { joints, raw, truth, wrists } of frames) {
    estimatedJoints.forEach((name, index) => {
      const estimated = jointOf(joints, name);
      const actual = truth[name];
      measures.errors[index]?.push(distance(estimated, actual) * 100);
      for (const axis of ['x', 'y', 'z'] as const) {
        const difference = (estimated[axis] - actual[axis]) * 100;
        measures.squares[index] = (measures.squares[index] ?? 0) + difference * difference;
        measures.absolutes[index] = (measures.absolutes[index] ?? 0) + Math.abs(difference);
      }
      if (raw) {
        measures.rawError += distance(raw[name], actual) * 100;
        measures.rawCount += 1;
      }
    });
    for (const side of sides) {
      const wrist = wrists[side];
      if (wrist) {
        const miss = distance(jointOf(joints, `${side}Hand`), wrist) * 1000;
        measures.handError += miss;
        measures.handErrorMax = Math.max(measures.handErrorMax, miss);
        measures.hands += 1;
      }
      const [shoulder, elbow, hand] = [truth[`${side}UpperArm`], truth[`${side}LowerArm`], truth[`${side}Hand`]];
      const bend = reject(subtract(elbow, shoulder), normalise(subtract(hand, shoulder)));
      if (Math.hypot(bend.x, bend.y, bend.z) > straightArm) {
        const angle = swivelAngle(shoulder, hand, elbow, jointOf(joints, `${side}LowerArm`));
        measures.swivels.push((Math.abs(angle) * 180) / Math.PI);
      }
    }
    bones.forEach(([from, to], index) => {
      const length = distance(jointOf(joints, from), jointOf(joints, to)) * 1000;
      const range = lengths[index];
      if (range) {
        range.least = Math.min(range.least, length);
        range.most = Math.max(range.most, length);
      }
    });
  }
  for (const { least, most } of lengths)
    if (most > 0) measures.boneVariation = Math.max(measures.boneVariation, most - least);

  const third = (at: (row: number) => Vec3, row: number): number =>
    thirdDifference(at(row - 3), at(row - 2), at(row - 1), at(row)) * rateHz ** 3;
  const frameAt = (row: number): MeasuredFrame => frames[row] as MeasuredFrame;
  for (let row = 3; row < frames.length; row++) {
    for (const name of estimatedJoints) {
      measures.jerk += third((r) => jointOf(frameAt(r).joints, name), row);
      measures.truthJerk += third((r) => frameAt(r).truth[name], row);
    }
  }
}

export function merge(parts: readonly Measures[]): Measures {
  const whole = emptyMeasures();
  for (const part of parts) addMeasures(whole, part);
  return whole;
}

/** Adds what was measured elsewhere. */
export function addMeasures(whole: Measures, part: Measures): void {
  part.errors.forEach((errors, index) => {
    for (const error of errors) whole.errors[index]?.push(error);
  });
  for (const swivel of part.swivels) whole.swivels.push(swivel);
  for (const key of ['squares', 'absolutes'] as const) {
    part[key].forEach((sum, index) => {
      whole[key][index] = (whole[key][index] ?? 0) + sum;
    });
  }
  for (const key of sums) {
    whole[key] += part[key];
  }
  whole.boneVariation = Math.max(whole.boneVariation, part.boneVariation);
  whole.handErrorMax = Math.max(whole.handErrorMax, part.handErrorMax);
}

export const rounded = (value: number, digits: number): number => Number(value.toFixed(digits));

function spread(values: readonly number[]): Spread {
  const sorted = Float64Array.from(values).sort();
  const quantile = (q: number) => sorted[Math.min(sorted.length - 1, Math.floor(q * sorted.length))] ?? Number.NaN;
  return { mean: rounded(mean(sorted), 3), median: rounded(quantile(0.5), 3), p95: rounded(quantile(0.95), 3) };
}

const sumOf = (values: readonly number[]): number => values.reduce((total, value) => total + value, 0);
const byJoint = <Figure>(figure: (index: number) => Figure): ByJoint<Figure> =>
  recordOf(reportNames, (_, index) => figure(index));

export function report(measures: Measures): Report {
  /** Coordinates of one joint. */
  const coordinates = (index: number): number => 3 * (measures.errors[index]?.length ?? 0);
  const all = sumOf(reportNames.map((_, index) => coordinates(index)));
  return {
    mpjpeCm: spread(measures.errors.flat()),
    joints: byJoint((index) => spread(measures.errors[index] ?? [])),
    mseCm2: rounded(sumOf(measures.squares) / all, 3),
    maeCm: rounded(sumOf(measures.absolutes) / all, 3),
    jointMseCm2: byJoint((index) => rounded((measures.squares[index] ?? 0) / coordinates(index), 3)),
    jointMaeCm: byJoint((index) => rounded((measures.absolutes[index] ?? 0) / coordinates(index), 3)),
    swivelDeg: rounded(mean(measures.swivels), 2),
    jerkRatio: rounded(measures.jerk / measures.truthJerk, 3),
    boneVariationMm: rounded(measures.boneVariation, 4),
    handErrorMm: rounded(measures.handError / measures.hands, 4),
    handErrorMaxMm: rounded(measures.handErrorMax, 2),
    ...(measures.rawCount > 0 ? { rawMpjpeCm: rounded(measures.rawError / measures.rawCount, 3) } : {}),
  };
}
