import { type Calibration, estimatedJoints, recordOf } from 'threepoint/core';
import { angleBetween, distance, type Vec3 } from 'threepoint/math';
import type { PoseRegressor } from '../../src/threepoint/core/estimation/networks/pose-regressor';
import { createDriver, type MeasuredMethod } from './drive';
import { thirdDifference } from './measures';
import type { RecordedFrame } from './recordings';

/** Lower bounds of the bins: true speed of the faster wrist [m/s], and of the head's rotation [rad/s]. */
export const speedBins = {
  hand: { rest: 0, slow: 0.15, quick: 0.6, fast: 1.8 },
  head: { rest: 0, slow: 0.2, quick: 0.8, fast: 2.5 },
} as const;
type SpeedOf = keyof typeof speedBins;
type Bin = keyof (typeof speedBins)['hand'];
const bins = Object.keys(speedBins.hand) as Bin[];

/** Speeds are differences over so many frames to either side. */
const halfSpan = 2;

/** A clip that is driven, with who moves in it and what network draws them. */
interface DrivenClip {
  readonly calibration: Calibration;
  readonly regressor: PoseRegressor | null;
  readonly frames: readonly RecordedFrame[];
  readonly rateHz: number;
}

/** Sums over the frames of one bin. */
interface BinSums {
  frames: number;
  /** Mean error of the six joints [m], on the shipping path and frame by frame. */
  shipped: number;
  frameByFrame: number;
  jerk: number;
  truthJerk: number;
}

export type SpeedTally = Readonly<Record<SpeedOf, Readonly<Record<Bin, BinSums>>>>;

const emptyBins = (): Record<Bin, BinSums> =>
  recordOf(bins, () => ({ frames: 0, shipped: 0, frameByFrame: 0, jerk: 0, truthJerk: 0 }));

export const emptySpeedTally = (): SpeedTally => ({ hand: emptyBins(), head: emptyBins() });

function binOf(what: SpeedOf, speed: number): Bin {
  const lower = speedBins[what];
  return bins.findLast((bin) => speed >= lower[bin]) ?? 'rest';
}

/** The speed of the faster wrist [m/s] and of the head's rotation [rad/s] about a frame. */
function speedsAt(frames: readonly RecordedFrame[], row: number, rateHz: number): Readonly<Record<SpeedOf, number>> {
  const [first, last] = [Math.max(0, row - halfSpan), Math.min(frames.length - 1, row + halfSpan)];
  const seconds = (last - first) / rateHz;
  const [before, after] = [frames[first]!, frames[last]!];
  const wrist = (hand: 'leftHand' | 'rightHand') => distance(before.truth[hand], after.truth[hand]) / seconds;
  const turned = angleBetween(before.frame.head.orientation, after.frame.head.orientation) / seconds;
  return { hand: Math.max(wrist('leftHand'), wrist('rightHand')), head: turned };
}

type Joints = Readonly<Record<string, Vec3>>;

const errorOf = (joints: Joints, truth: Joints): number =>
  estimatedJoints.reduce((sum, joint) => sum + distance(joints[joint]!, truth[joint]!), 0) / estimatedJoints.length;

/** The third difference of the six joints over four frames [m]. */
const jerkOf = (a: Joints, b: Joints, c: Joints, d: Joints): number =>
  estimatedJoints.reduce((sum, joint) => sum + thirdDifference(a[joint]!, b[joint]!, c[joint]!, d[joint]!), 0);

/** Adds one clip: the shipping path next to the same estimator without any filter or limit of speed. */
export async function addSpeeds(
  tally: SpeedTally,
  name: MeasuredMethod,
  { calibration, regressor, frames, rateHz }: DrivenClip,
): Promise<void> {
  const [shipped, frameByFrame] = [false, true].map((each) => createDriver(name, calibration, regressor, each));
  const drawn: Joints[] = [];
  for (const [row, { frame, truth }] of frames.entries()) {
    const { joints } = await shipped!.draw(frame);
    const alone = errorOf((await frameByFrame!.draw(frame)).joints, truth);
    drawn.push(joints);
    const speeds = speedsAt(frames, row, rateHz);
    for (const what of ['hand', 'head'] as const) {
      const sums = tally[what][binOf(what, speeds[what])];
      sums.frames += 1;
      sums.shipped += errorOf(joints, truth);
      sums.frameByFrame += alone;
      if (row < 3) continue;
      sums.jerk += jerkOf(drawn[row - 3]!, drawn[row - 2]!, drawn[row - 1]!, joints);
      sums.truthJerk += jerkOf(frames[row - 3]!.truth, frames[row - 2]!.truth, frames[row - 1]!.truth, truth);
    }
  }
}

/** A Markdown table: errors [cm], what time costs [%], and jerk relative to the truth's, by method and speed. */
export function speedTable(tallies: Readonly<Partial<Record<MeasuredMethod, SpeedTally>>>): string {
  const lines = [
    '| | speed of | frames | shipped [cm] | frame by frame [cm] | time costs | jerk |',
    '|---|---|---:|---:|---:|---:|---:|',
  ];
  for (const [method, tally] of Object.entries(tallies)) {
    for (const what of ['hand', 'head'] as const) {
      for (const bin of bins) {
        const { frames, shipped, frameByFrame, jerk, truthJerk } = tally[what][bin];
        if (frames === 0) continue;
        const [cm, alone] = [shipped, frameByFrame].map((sum) => (100 * sum) / frames) as [number, number];
        const cost = `${(100 * (cm / alone - 1)).toFixed(1)} %`;
        lines.push(
          `| ${method} | ${what}, ${bin} | ${frames} | ${cm.toFixed(2)} | ${alone.toFixed(2)} | ${cost} | ${(jerk / truthJerk).toFixed(2)} |`,
        );
      }
    }
  }
  return lines.join('\n');
}
