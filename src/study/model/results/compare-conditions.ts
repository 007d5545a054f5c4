import { asFamily } from '../../statistics/holm';
import { type PairedTTest, pairedTTest, type SignedRankTest, signedRankTest } from '../../statistics/paired-tests';
import { type MeanSummary, meanSummary } from '../../statistics/summaries';
import type { AnswerRow } from '../tables/answer-tables';
import type { TrialRow } from '../tables/study-tables';
import { answerMeasures, type Exclusion, type Measure, type Measured, scoreMeasures } from './measures';

/** The comparison of a question or a score under two conditions. */
export interface Comparison extends Measured {
  /** null: no participant has both. */
  readonly first: MeanSummary | null;
  readonly second: MeanSummary | null;
  /** The pairs in the order of the participants (or groups), for paired plots. */
  readonly pairs: readonly { readonly who: string; readonly first: number; readonly second: number }[];
  readonly test: PairedTTest | null;
  readonly signedRank: SignedRankTest | null;
  /** Adjusted over the family of comparisons made together. */
  readonly holmP: number | null;
  readonly ranksHolmP: number | null;
}

export interface Results {
  readonly comparisons: readonly Comparison[];
  readonly excluded: readonly Exclusion[];
}

type Pair = Comparison['pairs'][number];

/** Returns the participants with a value under both conditions, and the names of those who lack one. */
function paired({ of, means }: Measure, [first, second]: readonly [string, string]) {
  const pairs: Pair[] = [];
  const alone: Exclusion[] = [];
  for (const [who, own] of means) {
    const values = { first: own.get(first), second: own.get(second) };
    if (values.first !== undefined && values.second !== undefined) {
      pairs.push({ who, first: values.first, second: values.second });
    } else if (values.first !== undefined || values.second !== undefined) {
      const missing = values.first === undefined ? first : second;
      alone.push({ participant: who, of, reason: `no valid value under "${missing}"` });
    }
  }
  return { pairs, alone };
}

function tested(pairs: readonly Pair[]) {
  if (pairs.length === 0) return { first: null, second: null, test: null, signedRank: null };
  const first = pairs.map((pair) => pair.first);
  const second = pairs.map((pair) => pair.second);
  return {
    first: meanSummary(first),
    second: meanSummary(second),
    test: pairedTTest(first, second),
    signedRank: signedRankTest(first, second),
  };
}

/**
 * Compares measures between two conditions, first − second, as one family for Holm's correction. Only participants with
 * both values count; others are listed.
 */
export function compareConditions(measures: readonly Measure[], conditions: readonly [string, string]): Results {
  const excluded: Exclusion[] = [];
  const single = measures.map((measure) => {
    const { of, asked, unit, voided } = measure;
    const { pairs, alone } = paired(measure, conditions);
    for (const { condition, ...reason } of voided) if (conditions.includes(condition)) excluded.push(reason);
    excluded.push(...alone);
    return { of, asked, unit, pairs, ...tested(pairs) };
  });
  const comparisons = asFamily(
    single,
    ({ test }) => test?.p ?? null,
    ({ signedRank }) => signedRank?.p ?? null,
  );
  return { comparisons, excluded };
}

/** Compares every question or scale with numeric answers, as one family. */
export const compareAnswers = (rows: readonly AnswerRow[], conditions: readonly [string, string]): Results =>
  compareConditions(answerMeasures(rows), conditions);

/** Compares the scores of every task, with points and per cent as separate families. */
export const compareScores = (rows: readonly TrialRow[], conditions: readonly [string, string]) => ({
  points: compareConditions(scoreMeasures(rows, 'points'), conditions),
  percent: compareConditions(scoreMeasures(rows, 'percent'), conditions),
});
