import { type RankSumTest, rankSumTest, type WelchTest, welchTest } from '../../statistics/between-tests';
import { asFamily } from '../../statistics/holm';
import { type MeanSummary, meanOf, meanSummary } from '../../statistics/summaries';
import { completeValues } from './compare-all';
import type { Measure, Measured } from './measures';

/** The comparison of a measure between two cohorts. */
export interface CohortComparison extends Measured {
  /** The value of each participant (or group) in order, for strip charts. */
  readonly values: { readonly first: readonly number[]; readonly second: readonly number[] };
  /** null: no one of the cohort has a value. */
  readonly first: MeanSummary | null;
  readonly second: MeanSummary | null;
  /** null: a cohort is empty. */
  readonly test: WelchTest | null;
  readonly rankSum: RankSumTest | null;
  /** Adjusted over the family of comparisons. */
  readonly holmP: number | null;
  readonly ranksHolmP: number | null;
}

/** The compared cohorts, first − second, and the conditions over which each participant's mean is taken. */
export interface ComparedCohorts {
  readonly cohorts: readonly [string, string];
  readonly conditions: readonly string[];
}

const summaryOf = (values: readonly number[]) => (values.length === 0 ? null : meanSummary(values));

/**
 * Compares measures between two cohorts as one family for Holm's correction. Only participants with a value under each
 * condition count.
 */
export function compareCohorts(
  measures: readonly Measure[],
  { cohorts, conditions }: ComparedCohorts,
): readonly CohortComparison[] {
  const single = measures.map((measure) => {
    const { of, asked, unit } = measure;
    const { complete } = completeValues(measure, conditions);
    const valuesIn = (cohort: string) =>
      complete.flatMap(({ who, own }) => (measure.cohorts.get(who) === cohort ? [meanOf(own)] : []));
    const first = valuesIn(cohorts[0]);
    const second = valuesIn(cohorts[1]);
    const both = first.length > 0 && second.length > 0;
    return {
      ...{ of, asked, unit, values: { first, second }, first: summaryOf(first), second: summaryOf(second) },
      test: both ? welchTest(first, second) : null,
      rankSum: both ? rankSumTest(first, second) : null,
    };
  });
  return asFamily(
    single,
    ({ test }) => test?.p ?? null,
    ({ rankSum }) => rankSum?.p ?? null,
  );
}
