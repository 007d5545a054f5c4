import { rankSumTest, welchTest } from '../../statistics/between-tests';
import { meanOf } from '../../statistics/summaries';
import { completeValues } from './compare-all';
import { type Comparison, comparisonsOf } from './compare-conditions';
import type { Measure } from './measures';

/** The compared cohorts, first − second, and the conditions over which each participant's mean is taken. */
export interface ComparedCohorts {
  readonly sides: readonly [string, string];
  readonly conditions: readonly string[];
}

/**
 * Compares measures between two cohorts as one family for Holm's correction. Only participants with a value under each
 * condition count.
 */
export function compareCohorts(
  measures: readonly Measure[],
  { sides, conditions }: ComparedCohorts,
): readonly Comparison[] {
  const measured = measures.map((measure) => {
    const { complete } = completeValues(measure, conditions);
    const valuesIn = (cohort: string) =>
      complete.flatMap(({ who, own }) => (measure.cohorts.get(who) === cohort ? [meanOf(own)] : []));
    return { ...measure, values: { first: valuesIn(sides[0]), second: valuesIn(sides[1]) }, hypothesis: null };
  });
  return comparisonsOf(measured, ({ first, second }) => ({
    test: welchTest(first, second),
    ranks: rankSumTest(first, second),
    equivalence: null,
  }));
}
