import { estimatedJoints } from 'threepoint/core';
import { distance } from 'threepoint/math';
import { aftermathSeconds, type Loss } from './disturbances';
import { jointOf, type MeasuredFrame, rounded } from './measures';

/** Errors [cm] in some frames, with the hand lost and, in the same frames, seen. */
export interface LossErrors {
  readonly allCm: number;
  readonly allSeenCm: number;
  readonly elbowCm: number;
  readonly elbowSeenCm: number;
}

/** How far a shown joint moves in one frame. */
export interface LongestStep {
  readonly stepCm: number;
  /** The largest part of a step that the same joint does not make in the same frame with the hand seen. */
  readonly excessCm: number;
  /** Losses with an excess over 5 cm. */
  readonly over5Cm: number;
}

export interface LossReport {
  /** Mean length. */
  readonly milliseconds: number;
  readonly losses: number;
  readonly during: LossErrors;
  /** The half second after the return. */
  readonly after: LossErrors;
  readonly atLoss: LongestStep;
  readonly atReturn: LongestStep;
}

const noSums = () => ({ all: 0, allSeen: 0, joints: 0, elbow: 0, elbowSeen: 0, elbows: 0 });
type Sums = ReturnType<typeof noSums>;

const noSteps = () => ({ step: 0, excess: 0, over: 0 });
type StepTally = ReturnType<typeof noSteps>;

/** What losses of one kind did; add clip by clip, then report. */
export const emptyLossTally = () => ({
  losses: 0,
  lostSeconds: 0,
  during: noSums(),
  after: noSums(),
  atLoss: noSteps(),
  atReturn: noSteps(),
});
export type LossTally = ReturnType<typeof emptyLossTally>;

/** Estimates of the frames with losses and with both hands seen. */
interface Estimated {
  readonly lossy: readonly MeasuredFrame[];
  readonly seen: readonly MeasuredFrame[];
}

/** Adds one clip. */
export function addLosses(tally: LossTally, estimated: Estimated, losses: readonly Loss[], rateHz: number): void {
  const aftermath = Math.round(aftermathSeconds * rateHz);
  for (const { side, start, end } of losses) {
    tally.losses += 1;
    tally.lostSeconds += (end - start) / rateHz;
    addErrors(tally.during, estimated, side, start, end);
    addErrors(tally.after, estimated, side, end, end + aftermath);
    addSteps(tally.atLoss, estimated, start, Math.min(end, start + 2 * aftermath), rateHz);
    addSteps(tally.atReturn, estimated, end, Math.min(end + 2 * aftermath, estimated.lossy.length), rateHz);
  }
}

function addErrors(sums: Sums, { lossy, seen }: Estimated, side: Loss['side'], from: number, to: number): void {
  for (let row = from; row < Math.min(to, lossy.length); row++) {
    for (const joint of estimatedJoints) {
      const [a, b] = [errorOf(lossy[row]!, joint), errorOf(seen[row]!, joint)];
      sums.all += a;
      sums.allSeen += b;
      sums.joints += 1;
      if (joint === `${side}LowerArm`) {
        sums.elbow += a;
        sums.elbowSeen += b;
        sums.elbows += 1;
      }
    }
  }
}

const errorOf = ({ joints, truth }: MeasuredFrame, joint: (typeof estimatedJoints)[number]): number =>
  distance(jointOf(joints, joint), truth[joint]) * 100;

/** Steps into the frames [from, to), in centimetres per 1/60 s at any rate. */
function addSteps(tally: StepTally, { lossy, seen }: Estimated, from: number, to: number, rateHz: number): void {
  const step = (frames: readonly MeasuredFrame[], row: number, joint: string): number =>
    (distance(jointOf(frames[row - 1]!.joints, joint), jointOf(frames[row]!.joints, joint)) * 100 * rateHz) / 60;
  let worst = 0;
  for (let row = Math.max(1, from); row < to; row++) {
    for (const joint of Object.keys(lossy[row]!.joints)) {
      const moved = step(lossy, row, joint);
      tally.step = Math.max(tally.step, moved);
      worst = Math.max(worst, moved - step(seen, row, joint));
    }
  }
  tally.excess = Math.max(tally.excess, worst);
  if (worst > 5) tally.over += 1;
}

const lossErrors = ({ all, allSeen, joints, elbow, elbowSeen, elbows }: Sums): LossErrors => ({
  allCm: rounded(all / joints, 3),
  allSeenCm: rounded(allSeen / joints, 3),
  elbowCm: rounded(elbow / elbows, 3),
  elbowSeenCm: rounded(elbowSeen / elbows, 3),
});
const longestStep = ({ step, excess, over }: StepTally): LongestStep => ({
  stepCm: rounded(step, 2),
  excessCm: rounded(excess, 2),
  over5Cm: over,
});

export function reportLosses(tally: LossTally): LossReport {
  return {
    milliseconds: Math.round((tally.lostSeconds / tally.losses) * 1000),
    losses: tally.losses,
    during: lossErrors(tally.during),
    after: lossErrors(tally.after),
    atLoss: longestStep(tally.atLoss),
    atReturn: longestStep(tally.atReturn),
  };
}
