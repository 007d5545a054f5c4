import { readFileSync } from 'node:fs';
import type { Calibration } from 'threepoint/core';
import { makePose, type Pose, type Quat, transformPose, type Vec3 } from 'threepoint/math';
import type { CompletedHand } from '../../../../src/threepoint/core/estimation/complete-hands';
import { makeThreePoints, type ThreePoints } from '../../../../src/threepoint/core/estimation/ik/solve-ik';
import type { SeenHands } from '../../../../src/threepoint/core/estimation/networks/frame-features';
import { headingFromFloor } from '../../../../src/threepoint/core/tracking/heading';

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
    /** The pitch and yaw by which each hand is turned, as estimated from the frames before. */
    readonly handTilts: readonly Numbers[];
    readonly ikJoints: readonly Numbers[];
    readonly features: Numbers;
    readonly paperInput: Numbers;
  }[];
  /** The learned network's. */
  readonly inputs: readonly Numbers[];
}

/** Joints as they are estimated, and where torso and arm fitting put them on the skeleton, floor frame. */
export interface GoldenFit {
  readonly calibration: Calibration;
  readonly frames: readonly {
    /** A description of the hands. */
    readonly situation: string;
    readonly positions: readonly Numbers[];
    readonly rotations: readonly Numbers[];
    readonly estimated: readonly Numbers[];
    readonly fitted: readonly Numbers[];
    /** Whether the swivel limiter keeps the left and the right elbow out of the trunk. */
    readonly limited: readonly boolean[];
    /** The drawn joints by section 3.5 of the paper. */
    readonly published: Readonly<Record<string, Numbers>>;
  }[];
}

/** Arms that hang, and the rise of the headset that is estimated from them, frame by frame. */
export interface GoldenHeadsetRise {
  /** [m] */
  readonly arm: number;
  readonly frames: readonly {
    readonly seconds: number;
    /** From the shoulders to the wrists [arm lengths]. */
    readonly reach: readonly Numbers[];
    readonly seen: readonly boolean[];
    readonly hangingReach: Numbers;
    /** [m] */
    readonly rise: number;
  }[];
}

export interface GoldenModel {
  readonly sha256: string;
  readonly tolerance: number;
  readonly cases: readonly { readonly input: Numbers; readonly output: Numbers }[];
}

export function readGolden<Content>(name: string): Content {
  return JSON.parse(readFileSync(new URL(`../../../golden/${name}`, import.meta.url), 'utf8')) as Content;
}

/** A hand that is seen, or not; where it is said to be does not matter. */
export const goldenHand = (seen: boolean): CompletedHand => ({
  ...makePose<'floor'>(),
  source: seen ? 'tracked' : 'held',
  confidence: 1,
  goal: makePose(),
  jumped: false,
});

export const vec = ([x = Number.NaN, y = Number.NaN, z = Number.NaN]: Numbers): Vec3 => ({ x, y, z });
export const quat = ([x = Number.NaN, y = Number.NaN, z = Number.NaN, w = Number.NaN]: Numbers): Quat => ({
  x,
  y,
  z,
  w,
});

/** Head and wrists of a golden frame, floor frame, and which hands were seen. */
export interface GoldenPoints {
  readonly head: Pose<'floor'>;
  readonly leftHand: Pose<'floor'>;
  readonly rightHand: Pose<'floor'>;
  readonly seen: SeenHands;
}

export function goldenPoints({ positions, rotations, seen }: GoldenCase['frames'][number]): GoldenPoints {
  const pose = (index: number) => ({
    position: vec(positions[index] ?? []),
    orientation: quat(rotations[index] ?? []),
  });
  return {
    head: pose(0),
    leftHand: pose(1),
    rightHand: pose(2),
    seen: { left: seen[0] === true, right: seen[1] === true },
  };
}

/** Returns the points as IK receives them. */
export function pointsInHeading({ head, leftHand, rightHand }: GoldenPoints): ThreePoints {
  const points = makeThreePoints();
  const transform = headingFromFloor(head);
  transformPose(transform, head, points.head);
  transformPose(transform, leftHand, points.leftHand);
  transformPose(transform, rightHand, points.rightHand);
  return points;
}
