import { cohortsByParticipant } from './allocation';
import type { AnswerRow } from './answer-tables';
import { compareAll } from './compare-all';
import { type Comparison, compareAnswers, compareScores } from './compare-conditions';
import { frameTimes } from './frame-times';
import { questionnairesOf, type StudyPlan } from './plan';
import type { Questionnaire } from './questionnaires';
import { comparisonTable, frameTimeTable, overallTable } from './result-tables';
import type { StudyRecord } from './study-record';
import { answersIn, scalesIn, trialsIn } from './study-tables';
import type { Table } from './tidy-csv';

/** What a question asks about, or the name of a scale; empty: nothing is said. */
export function aboutIn(asked: readonly Questionnaire[], { asked: of }: Pick<Comparison, 'asked'>): string {
  const found = asked.find(({ id }) => id === of?.questionnaire);
  const scale = found?.scales.find(({ id }) => id === of?.question);
  return scale?.label ?? found?.questions.find(({ id }) => id === of?.question)?.about ?? '';
}

/** Whether a study is analysed as a whole; two conditions without cohorts are compared in pairs alone. */
export const comparedAsAWhole = ({ conditions, cohorts }: Pick<StudyPlan, 'conditions' | 'cohorts'>): boolean =>
  conditions.length > 2 || cohorts !== undefined;

/** All conditions and cohorts of a study at once; none where it is not analysed as a whole. */
export function overallComparisons(rows: readonly AnswerRow[], plan: StudyPlan) {
  if (!comparedAsAWhole(plan)) return [];
  const cohorts = cohortsByParticipant(plan);
  return compareAll(rows, {
    conditions: plan.conditions.map(({ id }) => id),
    cohortOf: (participant) => cohorts.get(participant)?.id ?? '',
  });
}

/** Every two conditions, the later one of the plan first: what comes first in it is what others are compared with. */
const pairsOf = ({ conditions }: StudyPlan): readonly (readonly [string, string])[] =>
  conditions.flatMap((baseline, index) => conditions.slice(index + 1).map(({ id }) => [id, baseline.id] as const));

/** What the page of results computes, of every two conditions. Throws where simulated records and records of people are mixed. */
export function resultTables(records: readonly StudyRecord[], plan: StudyPlan): readonly Table[] {
  const simulated = records[0]?.simulated ?? false;
  const pairs = pairsOf(plan);
  const asked = questionnairesOf(plan);
  const answers = answersIn(records, plan);
  const scales = scalesIn(records, plan);
  const trials = trialsIn(records);
  const compared = (name: string, of: (pair: readonly [string, string]) => readonly Comparison[]): Table => {
    const tableOf = (conditions: readonly [string, string], comparisons: readonly Comparison[]) =>
      comparisonTable(name, comparisons, { conditions, simulated, aboutOf: (one) => aboutIn(asked, one) });
    const { columns } = tableOf(['', ''], []);
    return { name, columns, rows: pairs.flatMap((pair) => tableOf(pair, of(pair)).rows) };
  };
  return [
    compared('answers-compared', (pair) => compareAnswers(answers, pair).comparisons),
    overallTable('answers-overall', overallComparisons(answers, plan), simulated),
    compared('scales-compared', (pair) => compareAnswers(scales, pair).comparisons),
    overallTable('scales-overall', overallComparisons(scales, plan), simulated),
    compared('scores-compared', (pair) => {
      const { points, percent } = compareScores(trials, pair);
      return [...points.comparisons, ...percent.comparisons];
    }),
    frameTimeTable(frameTimes(records), simulated),
  ];
}
