import { distance, type Vec3 } from 'threepoint/math';
import { addLosses, emptyLossTally, type LossTally, reportLosses } from '../losses';
import { emptyMeasures, type MeasuredFrame, type Measures, report, reportNames, rounded } from '../measures';
import { truthJoints } from '../recordings';
import { addErrorsAndJerk } from '../robustness';
import type { Staged } from '../situations';

/** Figures of one estimator in one situation by name; the name says the unit, and `kindOf` how it may differ. */
export type GoldenFigures = Readonly<Record<string, number>>;

/** The place of a largest step: clip, second and joint. */
export type StepPlaces = Readonly<Record<'stepCm' | 'excessCm', string>>;

/** What is added up over the pieces of one situation. */
export interface GoldenTally {
  readonly measures: Measures;
  readonly losses: LossTally;
  readonly steps: number[];
  frames: number;
  readonly largest: { stepCm: number; excessCm: number };
  readonly places: { stepCm: string; excessCm: string };
}

export const emptyGoldenTally = (): GoldenTally => ({
  measures: emptyMeasures(),
  losses: emptyLossTally(),
  steps: [],
  frames: 0,
  largest: { stepCm: 0, excessCm: 0 },
  places: { stepCm: '', excessCm: '' },
});

/** One driven piece: what was staged, and what came of it. */
export interface DrivenPiece {
  readonly name: string;
  /** The rate of the recording. */
  readonly recordedHz: number;
  readonly staged: Staged;
  readonly driven: readonly MeasuredFrame[];
  /** Undisturbed frames of the piece, where hands were lost. */
  readonly seen: readonly MeasuredFrame[] | null;
}

/** Adds a piece; frames on both sides of a gap are no motion. */
export function addPiece(tally: GoldenTally, piece: DrivenPiece): void {
  const { driven, recordedHz, seen } = piece;
  const { frames, rateHz, losses } = piece.staged;
  const starts = frames.flatMap(({ resumes }, row) => (row === 0 || resumes ? [row] : []));
  starts.forEach((start, index) => {
    const end = starts[index + 1] ?? driven.length;
    const run = driven.slice(start, end);
    addErrorsAndJerk(tally.measures, run, rateHz, recordedHz);
    for (let row = start + 1; row < end; row++) addSteps(tally, piece, row);
  });
  if (seen) addLosses(tally.losses, { lossy: driven, seen }, losses, rateHz);
  tally.frames += driven.length;
}

/** How far each joint goes into this frame [cm in 1/60 s], and how much further than the truth does. */
function addSteps(tally: GoldenTally, { name, staged, driven }: DrivenPiece, row: number): void {
  const [before, now] = [driven[row - 1] as MeasuredFrame, driven[row] as MeasuredFrame];
  const step = (from: Vec3 | undefined, to: Vec3 | undefined): number =>
    from && to ? (distance(from, to) * 100 * staged.rateHz) / 60 : 0;
  const note = (what: 'stepCm' | 'excessCm', value: number, joint: string): void => {
    if (value <= tally.largest[what]) return;
    tally.largest[what] = value;
    tally.places[what] = `${name}, ${staged.frames[row]!.frame.time.toFixed(2)} s, ${joint}`;
  };
  let most = 0;
  for (const joint of Object.keys(now.joints)) {
    const went = step(before.joints[joint], now.joints[joint]);
    most = Math.max(most, went);
    note('stepCm', went, joint);
  }
  tally.steps.push(most);
  for (const joint of truthJoints) {
    const excess = step(before.joints[joint], now.joints[joint]) - step(before.truth[joint], now.truth[joint]);
    note('excessCm', excess, joint);
  }
}

/** The figures of a situation, and where its largest steps were. */
export function goldenFigures(tally: GoldenTally): { readonly figures: GoldenFigures; readonly places: StepPlaces } {
  const of = report(tally.measures);
  const spread = (name: string, { mean, median, p95 }: { mean: number; median: number; p95: number }) => ({
    [`${name}MeanCm`]: mean,
    [`${name}MedianCm`]: median,
    [`${name}P95Cm`]: p95,
  });
  const sorted = Float64Array.from(tally.steps).sort();
  const figures = {
    frames: tally.frames,
    ...spread('mpjpe', of.mpjpeCm),
    ...Object.assign({}, ...reportNames.map((name) => spread(name, of.joints[name]))),
    swivelDeg: of.swivelDeg,
    jerkRatio: of.jerkRatio,
    boneVariationMm: of.boneVariationMm,
    handErrorMm: of.handErrorMm,
    handErrorMaxMm: of.handErrorMaxMm,
    stepP999Cm: rounded(sorted[Math.floor(0.999 * sorted.length)] ?? 0, 2),
    stepCm: rounded(tally.largest.stepCm, 2),
    excessCm: rounded(tally.largest.excessCm, 2),
    ...(tally.losses.losses > 0 ? lossFigures(tally.losses) : {}),
  };
  return { figures, places: tally.places };
}

function lossFigures(tally: LossTally): GoldenFigures {
  const { losses, during, after, atLoss, atReturn } = reportLosses(tally);
  return {
    losses,
    duringMeanCm: during.allCm,
    duringElbowCm: during.elbowCm,
    afterMeanCm: after.allCm,
    afterElbowCm: after.elbowCm,
    lossStepCm: atLoss.stepCm,
    lossExcessCm: atLoss.excessCm,
    lossesOver5Cm: atLoss.over5Cm,
    returnStepCm: atReturn.stepCm,
    returnExcessCm: atReturn.excessCm,
    returnsOver5Cm: atReturn.over5Cm,
  };
}

type Kind = 'count' | 'jumps' | 'smooth' | 'exact' | 'error';

/** What a figure is: counts must be the same, jumps no more, smoothness no worse, errors at most 1 % worse. */
function kindOf(figure: string): Kind {
  if (figure === 'frames' || figure === 'losses') return 'count';
  if (figure.endsWith('Over5Cm')) return 'jumps';
  if (figure === 'jerkRatio' || /([sS]tep|[eE]xcess)(P999)?Cm$/.test(figure)) return 'smooth';
  return figure === 'boneVariationMm' || figure.startsWith('handError') ? 'exact' : 'error';
}

/** Beyond the frozen figure: a share of it, and so much in its own unit for what rounding does. */
const slack: Readonly<Record<Kind, readonly [share: number, amount: number]>> = {
  count: [0, 0],
  jumps: [0, 0],
  smooth: [0.001, 0.011],
  exact: [0, 0.011],
  error: [0.01, 0.0011],
};

/** Whether a figure is worse than what was frozen lets it be; one that is missing (NaN) is. */
export function worse(figure: string, frozen: number, now: number): boolean {
  const kind = kindOf(figure);
  if (kind === 'count') return now !== frozen;
  const [share, amount] = slack[kind];
  return !(now <= frozen * (1 + share) + amount);
}

export interface Difference {
  readonly row: string;
  readonly figure: string;
  readonly frozen: number;
  readonly now: number;
  readonly worse: boolean;
}

export type GoldenTable = Readonly<Record<string, GoldenFigures>>;

/** Every figure of both tables; one that either lacks is worse. */
export function compareTables(frozen: GoldenTable, now: GoldenTable): Difference[] {
  const union = (a: object, b: object) => [...new Set([...Object.keys(a), ...Object.keys(b)])];
  return union(frozen, now).flatMap((row) =>
    union(frozen[row] ?? {}, now[row] ?? {}).map((figure) => {
      const [a, b] = [frozen[row]?.[figure] ?? Number.NaN, now[row]?.[figure] ?? Number.NaN];
      return { row, figure, frozen: a, now: b, worse: worse(figure, a, b) };
    }),
  );
}
