import { readFileSync } from 'node:fs';
import type { Calibration } from '../../../src/core/body/calibration';
import type { Quat } from '../../../src/core/math/quat';
import type { Vec3 } from '../../../src/core/math/vec3';
import type { ContinuedFrame } from '../../../src/core/tracking/hand-continuity';

type Numbers = readonly number[];

/** What training/threepoint_training/golden.py writes. */
export interface GoldenCase {
  readonly calibration: Calibration;
  readonly restOffsets: Readonly<Record<string, Numbers>>;
  readonly window: Numbers;
  readonly frames: readonly {
    readonly time: number;
    readonly positions: readonly Numbers[];
    readonly rotations: readonly Numbers[];
    readonly seen: readonly boolean[];
    readonly ikJoints: readonly Numbers[];
    readonly features: Numbers;
    readonly paperInput: Numbers;
  }[];
  /** The learned network's. */
  readonly inputs: readonly Numbers[];
}

/** Joints as somebody estimates them, and where the skeleton puts them, floor frame. */
export interface GoldenPlacement {
  readonly calibration: Calibration;
  readonly frames: readonly {
    readonly positions: readonly Numbers[];
    readonly rotations: readonly Numbers[];
    readonly estimated: readonly Numbers[];
    readonly placed: readonly Numbers[];
  }[];
}

export interface GoldenModel {
  readonly sha256: string;
  readonly tolerance: number;
  readonly cases: readonly { readonly input: Numbers; readonly output: Numbers }[];
}

export function readGolden<Content>(name: string): Content {
  return JSON.parse(readFileSync(new URL(`../../golden/${name}`, import.meta.url), 'utf8')) as Content;
}

export const vec = ([x = Number.NaN, y = Number.NaN, z = Number.NaN]: Numbers): Vec3 => ({ x, y, z });
export const quat = ([x = Number.NaN, y = Number.NaN, z = Number.NaN, w = Number.NaN]: Numbers): Quat => ({
  x,
  y,
  z,
  w,
});

/** A golden frame as the estimators see it. */
export function continuedFrame(frame: GoldenCase['frames'][number]): ContinuedFrame {
  const pose = (index: number) => ({
    position: vec(frame.positions[index] ?? []),
    orientation: quat(frame.rotations[index] ?? []),
  });
  const hand = (index: 1 | 2) => {
    const seen = frame.seen[index - 1] === true;
    return { ...pose(index), seen, trust: seen ? 1 : 0, way: { goal: pose(index), rests: !seen, since: 0, age: 0 } };
  };
  return { time: frame.time, head: pose(0), leftHand: hand(1), rightHand: hand(2) };
}
