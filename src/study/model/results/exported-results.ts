import { cohortsByParticipant } from '../plan/allocation';
import type { StudyPlan } from '../plan/plan';
import type { StudyRecord } from '../records/study-record';
import { answersIn, scalesIn, trialsIn } from '../tables/study-tables';
import type { Table } from '../tables/tidy-csv';
import { compareAll } from './compare-all';
import { type ComparedCohorts, compareCohorts } from './compare-cohorts';
import { compareConditions } from './compare-conditions';
import { frameTimes } from './frame-times';
import { answerMeasures, type CohortOf, isPlanned, type Measure, scoreMeasures } from './measures';
import { cohortsTable, conditionsTable, frameTimeTable, overallTable } from './result-tables';

/** Returns a function from participants to the cohorts of the plan; empty: it has none. */
export function cohortLookup(plan: StudyPlan): CohortOf {
  const cohorts = cohortsByParticipant(plan);
  return (participant) => cohorts.get(participant)?.id ?? '';
}

/** A part of the results for each family of Holm's correction. */
export interface ByFamily<T> {
  readonly answers: T;
  readonly scales: T;
  readonly points: T;
  readonly percent: T;
  /** The answers, scales and points that the plan names; all other families are exploratory. */
  readonly planned: T;
}

export type StudyMeasures = ByFamily<readonly Measure[]>;

/** Returns the measures of a study; throws if simulated records and records of people are mixed. */
export function measuresIn(records: readonly StudyRecord[], plan: StudyPlan): StudyMeasures {
  const cohortOf = cohortLookup(plan);
  const answers = answerMeasures(answersIn(records, plan), cohortOf);
  const scales = answerMeasures(scalesIn(records, plan), cohortOf);
  const trials = trialsIn(records);
  const points = scoreMeasures(trials, 'points', cohortOf);
  const percent = scoreMeasures(trials, 'percent', cohortOf);
  const planned = [...answers, ...scales, ...points].filter((measure) => isPlanned(measure, plan));
  return { answers, scales, points, percent, planned };
}

/** Returns whether a study is analysed as a whole; two conditions without cohorts are only compared in pairs. */
export const hasOverallAnalysis = ({ conditions, cohorts }: Pick<StudyPlan, 'conditions' | 'cohorts'>): boolean =>
  conditions.length > 2 || cohorts !== undefined;

/** Returns the comparison of all conditions and cohorts at once; nothing if the study is not analysed as a whole. */
export const overallComparisons = (measures: readonly Measure[], plan: Pick<StudyPlan, 'conditions' | 'cohorts'>) =>
  hasOverallAnalysis(plan)
    ? compareAll(
        measures,
        plan.conditions.map(({ id }) => id),
      )
    : [];

/** Returns every pair, the later one of the plan first, because the earlier one is the reference. */
const pairsOf = (of: readonly { readonly id: string }[]): readonly (readonly [string, string])[] =>
  of.flatMap((baseline, index) => of.slice(index + 1).map(({ id }) => [id, baseline.id] as const));

/** Returns the conditions over which cohorts are compared: all, and each of several alone. */
export function cohortViews({ conditions }: Pick<StudyPlan, 'conditions'>): readonly (readonly string[])[] {
  const all = conditions.map(({ id }) => id);
  return all.length > 1 ? [all, ...all.map((id) => [id])] : [all];
}

const cohortComparisonsOf = (plan: StudyPlan): readonly ComparedCohorts[] =>
  pairsOf(plan.cohorts ?? []).flatMap((sides) => cohortViews(plan).map((conditions) => ({ sides, conditions })));

/**
 * Returns the results of the page for every pair of conditions and cohorts. Throws if simulated records and records of
 * people are mixed.
 */
export function resultTables(records: readonly StudyRecord[], plan: StudyPlan): readonly Table[] {
  const measures = measuresIn(records, plan);
  const simulated = records[0]?.simulated ?? false;
  /** Returns three tables of the same measures; p is adjusted within each family. */
  const tablesOf = (name: string, families: readonly (readonly Measure[])[]): readonly Table[] => {
    const facts = { family: name === 'planned' ? 'planned' : 'explored', simulated, plan } as const;
    const pairs = pairsOf(plan.conditions).flatMap((sides) =>
      families.map((family) => ({ sides, comparisons: compareConditions(family, sides, plan).comparisons })),
    );
    const cohorts = cohortComparisonsOf(plan).flatMap((compared) =>
      families.map((family) => ({ ...compared, comparisons: compareCohorts(family, compared) })),
    );
    return [
      conditionsTable(`${name}-compared`, pairs, facts),
      overallTable(`${name}-overall`, overallComparisons(families[0] ?? [], plan), facts),
      cohortsTable(`${name}-cohorts`, cohorts, facts),
    ];
  };
  return [
    ...tablesOf('planned', [measures.planned]),
    ...tablesOf('answers', [measures.answers]),
    ...tablesOf('scales', [measures.scales]),
    ...tablesOf('scores', [measures.points, measures.percent]),
    frameTimeTable(frameTimes(records, cohortLookup(plan)), { simulated }),
  ];
}
