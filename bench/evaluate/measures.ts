import { estimatedJoints } from '../../src/core/body/joints';
import type { JointPositions } from '../../src/core/estimation/joint-positions';
import { swivelAngle } from '../../src/core/body/two-bone-ik';
import { distance, normalise, reject, subtract, type Vec3 } from '../../src/core/math/vec3';
import type { TruthJoint } from './recordings';

/** Names of the six joints in every report. */
export const reportNames = ['leftElbow', 'rightElbow', 'leftShoulder', 'rightShoulder', 'spine', 'pelvis'] as const;

export interface Spread {
  readonly mean: number;
  readonly median: number;
  readonly p95: number;
}

export interface Report {
  readonly mpjpeCm: Spread;
  readonly joints: Readonly<Record<(typeof reportNames)[number], Spread>>;
  readonly mseCm2: number;
  readonly maeCm: number;
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

/** What one estimator did with some clips; add clip by clip, merge people, then report. */
export interface Measures {
  readonly errors: number[][];
  squares: number;
  absolutes: number;
  coordinates: number;
  swivels: number[];
  jerk: number;
  truthJerk: number;
  boneVariation: number;
  handError: number;
  handErrorMax: number;
  hands: number;
  rawError: number;
  rawCount: number;
}

export const emptyMeasures = (): Measures => ({
  errors: estimatedJoints.map(() => []),
  squares: 0,
  absolutes: 0,
  coordinates: 0,
  swivels: [],
  jerk: 0,
  truthJerk: 0,
  boneVariation: 0,
  handError: 0,
  handErrorMax: 0,
  hands: 0,
  rawError: 0,
  rawCount: 0,
});

/** One frame of one clip as estimated, beside its truth. Floor frame [m]. */
export interface MeasuredFrame {
  readonly joints: Readonly<Record<string, Vec3>>;
  readonly raw: JointPositions | null;
  readonly truth: Readonly<Record<TruthJoint, Vec3>>;
  readonly wrists: { readonly left: Vec3; readonly right: Vec3 };
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

const jointOf = (joints: Readonly<Record<string, Vec3>>, name: string): Vec3 => {
  const joint = joints[name];
  if (!joint) throw new Error(`the estimator gave no ${name}`);
  return joint;
};

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
        measures.squares += difference * difference;
        measures.absolutes += Math.abs(difference);
        measures.coordinates += 1;
      }
      if (raw) {
        measures.rawError += distance(raw[name], actual) * 100;
        measures.rawCount += 1;
      }
    });
    for (const side of ['left', 'right'] as const) {
      const miss = distance(jointOf(joints, `${side}Hand`), wrists[side]) * 1000;
      measures.handError += miss;
      measures.handErrorMax = Math.max(measures.handErrorMax, miss);
      measures.hands += 1;
      const [shoulder, elbow, wrist] = [truth[`${side}UpperArm`], truth[`${side}LowerArm`], truth[`${side}Hand`]];
      const bend = reject(subtract(elbow, shoulder), normalise(subtract(wrist, shoulder)));
      if (Math.hypot(bend.x, bend.y, bend.z) > straightArm) {
        const angle = swivelAngle(shoulder, wrist, elbow, jointOf(joints, `${side}LowerArm`));
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

  const third = (at: (row: number) => Vec3, row: number): number => {
    const [a, b, c, d] = [at(row - 3), at(row - 2), at(row - 1), at(row)];
    const along = (axis: 'x' | 'y' | 'z') => d[axis] - 3 * c[axis] + 3 * b[axis] - a[axis];
    return Math.hypot(along('x'), along('y'), along('z')) * rateHz ** 3;
  };
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
  for (const part of parts) {
    part.errors.forEach((errors, index) => {
      for (const error of errors) whole.errors[index]?.push(error);
    });
    for (const swivel of part.swivels) whole.swivels.push(swivel);
    for (const key of [
      'squares',
      'absolutes',
      'coordinates',
      'jerk',
      'truthJerk',
      'handError',
      'hands',
      'rawError',
      'rawCount',
    ] as const) {
      whole[key] += part[key];
    }
    whole.boneVariation = Math.max(whole.boneVariation, part.boneVariation);
    whole.handErrorMax = Math.max(whole.handErrorMax, part.handErrorMax);
  }
  return whole;
}

const rounded = (value: number, digits: number): number => Number(value.toFixed(digits));
const mean = (values: Float64Array): number => values.reduce((sum, value) => sum + value, 0) / values.length;

function spread(values: readonly number[]): Spread {
  const sorted = Float64Array.from(values).sort();
  const quantile = (q: number) => sorted[Math.min(sorted.length - 1, Math.floor(q * sorted.length))] ?? Number.NaN;
  return { mean: rounded(mean(sorted), 3), median: rounded(quantile(0.5), 3), p95: rounded(quantile(0.95), 3) };
}

export function report(measures: Measures): Report {
  return {
    mpjpeCm: spread(measures.errors.flat()),
    joints: Object.fromEntries(
      reportNames.map((name, index) => [name, spread(measures.errors[index] ?? [])]),
    ) as Report['joints'],
    mseCm2: rounded(measures.squares / measures.coordinates, 3),
    maeCm: rounded(measures.absolutes / measures.coordinates, 3),
    swivelDeg: rounded(mean(Float64Array.from(measures.swivels)), 2),
    jerkRatio: rounded(measures.jerk / measures.truthJerk, 3),
    boneVariationMm: rounded(measures.boneVariation, 4),
    handErrorMm: rounded(measures.handError / measures.hands, 4),
    handErrorMaxMm: rounded(measures.handErrorMax, 2),
    ...(measures.rawCount > 0 ? { rawMpjpeCm: rounded(measures.rawError / measures.rawCount, 3) } : {}),
  };
}
