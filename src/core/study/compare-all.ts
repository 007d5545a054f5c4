import { type VarianceAnalysis, varianceAnalysis } from '../statistics/analysis-of-variance';
import { holm } from '../statistics/holm';
import { friedmanTest, kruskalWallisTest, type RankAnalysis } from '../statistics/rank-analyses';
import { meanOf } from '../statistics/summaries';
import type { AnswerRow } from './answer-tables';
import { type Asked, askedIn, isOf } from './compare-conditions';
import { refuseMixture } from './study-tables';

/** One question, or one scale, under all conditions and in all cohorts. */
export interface OverallComparison {
  readonly of: string;
  readonly asked: Asked;
  /** Participants who have a valid answer under every condition; the others are left out. */
  readonly n: number;
  readonly leftOut: readonly string[];
  /** null: a cohort has no one whose answers are complete. */
  readonly variance: VarianceAnalysis | null;
  /** Friedman's test of the conditions; with one condition, Kruskal and Wallis's of the cohorts; null as above. */
  readonly ranks: RankAnalysis | null;
  /** Of the conditions' effect (with one condition: the cohorts'), as corrected, adjusted over all that is compared here. */
  readonly holmP: number | null;
  readonly ranksHolmP: number | null;
}

export interface OverallOptions {
  /** Ids, in the order of the plan. */
  readonly conditions: readonly string[];
  /** The cohort of a participant; all the same where a plan has none. */
  readonly cohortOf: (participant: string) => string;
}

/** The mean of each participant's valid answers under each condition; NaN: there is none. */
function valuesOf(rows: readonly AnswerRow[], conditions: readonly string[]): ReadonlyMap<string, readonly number[]> {
  const participants = [...new Set(rows.map(({ participant }) => participant))].toSorted();
  const valid = (participant: string, condition: string) =>
    rows.flatMap((row) =>
      row.participant === participant && row.condition === condition && !row.excluded && typeof row.answer === 'number'
        ? [row.answer]
        : [],
    );
  return new Map(participants.map((who) => [who, conditions.map((condition) => meanOf(valid(who, condition)))]));
}

function analysed(rows: readonly AnswerRow[], { conditions, cohortOf }: OverallOptions) {
  const values = [...valuesOf(rows, conditions)];
  const complete = values.filter(([, own]) => own.every(Number.isFinite));
  const leftOut = values.filter(([, own]) => !own.every(Number.isFinite)).map(([who]) => who);
  const names = [...new Set(values.map(([who]) => cohortOf(who)))].toSorted();
  const cohorts = names.map((name) => complete.filter(([who]) => cohortOf(who) === name).map(([, own]) => own));
  const n = complete.length;
  if (cohorts.length === 0 || cohorts.some(({ length }) => length === 0)) {
    return { n, leftOut, variance: null, ranks: null };
  }
  const several = conditions.length > 1;
  const ranks = several
    ? friedmanTest(complete.map(([, own]) => own))
    : cohorts.length > 1
      ? kruskalWallisTest(cohorts.map((members) => members.flat()))
      : null;
  return { n, leftOut, variance: varianceAnalysis(cohorts), ranks };
}

/**
 * Every question (or scale) that is answered with a number, all conditions and cohorts at once, as one family for Holm's correction. Throws where
 * simulated rows and rows of people are mixed.
 */
export function compareAll(rows: readonly AnswerRow[], options: OverallOptions): readonly OverallComparison[] {
  refuseMixture(rows);
  const single = askedIn(rows).map(({ of, asked }) => ({
    of,
    asked,
    ...analysed(
      rows.filter((row) => isOf(row, asked)),
      options,
    ),
  }));
  const tested = ({ variance }: (typeof single)[number]) => {
    const effect = variance?.within ?? variance?.between ?? null;
    return effect?.correctedP ?? effect?.p ?? null;
  };
  const holmP = holm(single.map(tested));
  const ranksHolmP = holm(single.map(({ ranks }) => ranks?.p ?? null));
  return single.map((one, index) => ({
    ...one,
    holmP: holmP[index] ?? null,
    ranksHolmP: ranksHolmP[index] ?? null,
  }));
}
