import { type VarianceAnalysis, varianceAnalysis } from '../../statistics/analysis-of-variance';
import { asFamily } from '../../statistics/holm';
import { friedmanTest, kruskalWallisTest, type RankAnalysis } from '../../statistics/rank-analyses';
import type { Measure, Measured } from './measures';

/** One measure under all conditions and in all cohorts. */
export interface OverallComparison extends Measured {
  /** Participants (or groups) who have a valid value under every condition; the others are left out. */
  readonly n: number;
  readonly leftOut: readonly string[];
  /** null: a cohort has no one whose values are complete. */
  readonly variance: VarianceAnalysis | null;
  /** Friedman's test of the conditions; with one condition, Kruskal and Wallis's of the cohorts; null as above. */
  readonly ranks: RankAnalysis | null;
  /** Of the conditions' effect (with one condition: the cohorts'), as corrected, adjusted over all that is compared here. */
  readonly holmP: number | null;
  readonly ranksHolmP: number | null;
}

/** The values of those who have one under every condition, cohort by cohort. */
export function completeValues({ means, cohorts }: Measure, conditions: readonly string[]) {
  const values = [...cohorts.keys()].toSorted().map((who) => ({
    who,
    own: conditions.map((condition) => means.get(who)?.get(condition)),
  }));
  const isComplete = (own: readonly (number | undefined)[]): own is readonly number[] => !own.includes(undefined);
  const complete = values.flatMap(({ who, own }) => (isComplete(own) ? [{ who, own }] : []));
  return { complete, leftOut: values.flatMap(({ who, own }) => (isComplete(own) ? [] : [who])) };
}

function analysed(measure: Measure, conditions: readonly string[]) {
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

/** Measures under all conditions (ids in the order of the plan) and in all cohorts at once, as one family for Holm's correction. */
export function compareAll(measures: readonly Measure[], conditions: readonly string[]): readonly OverallComparison[] {
  const single = measures.map((measure) => {
    const { of, asked, unit } = measure;
    return { of, asked, unit, ...analysed(measure, conditions) };
  });
  return asFamily(
    single,
    ({ variance }) => {
      const effect = variance?.within ?? variance?.between ?? null;
      return effect?.correctedP ?? effect?.p ?? null;
    },
    ({ ranks }) => ranks?.p ?? null,
  );
}
