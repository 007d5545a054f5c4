import { holm } from '../../statistics/holm';
import { twoSidedP } from '../../statistics/summaries';

/** A row of the paper's tables 9 and 10: paired t-tests of its method (ours) against IK with fifteen participants. */
export interface PaperRow {
  readonly question: string;
  readonly ours: number;
  readonly ik: number;
  readonly t: number;
  /** The printed value with three decimals. */
  readonly printedP: number;
}

const row = (question: string, ours: number, ik: number, t: number, printedP: number): PaperRow => ({
  question,
  ours,
  ik,
  t,
  printedP,
});

/** Table 9 (Q1 to Q7) and table 10 (Q8 to Q12). */
export const paperRows: readonly PaperRow[] = [
  row('Q1', 4.8, 4.2, 4.582, 0.003),
  row('Q2', 4.86, 4.2, 3.567, 0.003),
  row('Q3', 4.53, 4.2, 1.434, 0.173),
  row('Q4', 4.73, 4.26, 2.167, 0.047),
  row('Q5', 4.93, 4.46, 2.449, 0.028),
  row('Q6', 4.8, 4.38, 2.167, 0.047),
  row('Q7', 4.93, 4.33, 3.674, 0.002),
  row('Q8', 4.66, 4.26, 3.055, 0.008),
  row('Q9', 4.73, 4.26, 3.5, 0.003),
  row('Q10', 4.53, 3.93, 3.674, 0.002),
  row('Q11', 4.73, 4.13, 2.304, 0.002),
  row('Q12', 4.66, 4.26, 2.449, 0.028),
];

/** Fifteen pairs. */
export const paperDf = 14;

/** A row with the values computed from its t. */
export interface CheckedPaperRow extends PaperRow {
  readonly p: number;
  /** Whether the printed p is this p, rounded or truncated after its third decimal (the paper truncates). */
  readonly follows: boolean;
  /** Adjusted over all twelve questions; the paper does not correct. */
  readonly holmP: number;
  /** Cohen's d_z, which is t / √n. */
  readonly dz: number;
}

const lastPlace = 0.001;

/** Returns the paper's tests with p recomputed from t with df = 14. */
export function checkedPaperRows(): readonly CheckedPaperRow[] {
  const pValues = paperRows.map(({ t }) => twoSidedP(t, paperDf));
  const adjusted = holm(pValues);
  return paperRows.map((one, index) => {
    const p = pValues[index] as number;
    return {
      ...one,
      p,
      follows: Math.abs(p - one.printedP) < lastPlace,
      holmP: adjusted[index] as number,
      dz: one.t / Math.sqrt(paperDf + 1),
    };
  });
}

/** Scores in the text and in figures 12 and 14; each target of archery scores once, 5 + 10 + 15 + 20. */
export const paperScores = [
  { task: 'archery', maximum: 50, ours: 42.66, ik: 35.73, printedPercent: { ours: 85.32, ik: 71.46 } },
  { task: 'ball', maximum: 20, ours: 19, ik: 16.6, printedPercent: { ours: 95, ik: 83 } },
] as const;

/** Tables 5 and 6: milliseconds of the main thread per frame. The text calls the difference "approximately 60%". */
export const paperFrameTimes = [
  {
    title: 'single user (table 5)',
    frames: 6736,
    ours: { minMs: 3.19, maxMs: 14.75, meanMs: 6.73 },
    ik: { minMs: 3.81, maxMs: 19.65, meanMs: 10.23 },
  },
  {
    title: 'several users (table 6)',
    frames: 8661,
    ours: { minMs: 3.36, maxMs: 17.01, meanMs: 9.21 },
    ik: { minMs: 4.28, maxMs: 22.41, meanMs: 16.78 },
  },
] as const;

/** Returns the share of the mean frame time that the paper's method saves in its own tables. */
export const savedShare = ({ ours, ik }: (typeof paperFrameTimes)[number]): number => 1 - ours.meanMs / ik.meanMs;
