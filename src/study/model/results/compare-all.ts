import { type VarianceAnalysis, varianceAnalysis } from '../../statistics/analysis-of-variance';
import { asFamily } from '../../statistics/holm';
import { friedmanTest, kruskalWallisTest, type RankAnalysis } from '../../statistics/rank-analyses';
import type { Measure, MeasureName } from './measures';

/** The comparison of a measure under all conditions and in all cohorts. */
export interface OverallComparison extends MeasureName {
  /** Participants (or groups) with a valid value under every condition; others are left out. */
  readonly n: number;
  readonly leftOut: readonly string[];
  /** null: a cohort has no complete values. */
  readonly variance: VarianceAnalysis | null;
  /**
   * Friedman's test of the conditions, or Kruskal and Wallis's of the cohorts with one condition; null: a cohort has no
   * complete values.
   */
  readonly ranks: RankAnalysis | null;
  /**
   * The corrected p of the conditions' effect (with one condition: the cohorts'), adjusted over all measures in this
   * comparison.
   */
  readonly holmP: number | null;
  readonly ranksHolmP: number | null;
}

/** Returns the complete values, cohort by cohort. */
export function completeValues({ means, cohorts }: Measure, conditions: readonly string[]) {
  const values = [...cohorts.keys()].toSorted().map((who) => ({
    who,
    own: conditions.map((condition) => means.get(who)?.get(condition)),
  }));
  const isComplete = (own: readonly (number | undefined)[]): own is readonly number[] => !own.includes(undefined);
  const complete = values.flatMap(({ who, own }) => (isComplete(own) ? [{ who, own }] : []));
  return { complete, leftOut: values.flatMap(({ who, own }) => (isComplete(own) ? [] : [who])) };
}

function analyse(measure: Measure, conditions: readonly string[]) {
  const { complete, leftOut } = completeValues(measure, conditions);
  const names = [...new Set(measure.cohorts.values())].toSorted();
  const cohorts = names.map((name) =>
    complete.filter(({ who }) => measure.cohorts.get(who) === name).map(({ own }) => own),
  );
  const n = complete.length;
  if (cohorts.length === 0 || cohorts.some(({ length }) => length === 0)) {
    return { n, leftOut, variance: null, ranks: null };
  }
  const several = conditions.length > 1;
  const ranks = several
    ? friedmanTest(complete.map(({ own }) => own))
    : cohorts.length > 1
      ? kruskalWallisTest(cohorts.map((members) => members.flat()))
      : null;
  return { n, leftOut, variance: varianceAnalysis(cohorts), ranks };
}

/**
 * Compares measures under all conditions (ids in the order of the plan) and in all cohorts, as one family for Holm's
 * correction.
 */
export function compareAll(measures: readonly Measure[], conditions: readonly string[]): readonly OverallComparison[] {
  const single = measures.map((measure) => {
    const { of, asked, unit } = measure;
    return { of, asked, unit, ...analyse(measure, conditions) };
  });
  return asFamily(single, {
    holmP: ({ variance }) => {
      const effect = variance?.within ?? variance?.between ?? null;
      return effect?.correctedP ?? effect?.p ?? null;
    },
    ranksHolmP: ({ ranks }) => ranks?.p ?? null,
  });
}
