import { meanOf } from '../../statistics/summaries';
import { type PlannedTests, plannedMeasures } from '../plan/hypotheses';
import type { StudyPlan } from '../plan/plan';
import { questionnaireNamed } from '../questionnaires/questionnaires';
import { type AnswerRow, rejectMixture, type TrialRow } from '../tables/study-tables';

/** A participant or an answer that is left out of the results, and the reason. */
export interface Exclusion {
  readonly participant: string;
  /** The question or task that it concerns. */
  readonly of: string;
  readonly reason: string;
}

/** A question or a scale of a questionnaire after a task. */
export type QuestionPlace = Pick<AnswerRow, 'task' | 'questionnaire' | 'question'>;

export interface MeasureName {
  /** "Q1" or the id of a task; for a question in more than one place "archery/nasa-tlx/mental". */
  readonly of: string;
  /** The question and its place; null: scores. */
  readonly asked: QuestionPlace | null;
  readonly unit: 'answer' | 'points' | 'percent';
}

/** Returns the name of a measure in plans; null: a score in per cent, because plans name scores in points. */
export function nameInPlan({ of, asked, unit }: MeasureName): string | null {
  if (asked) return `${asked.task}/${asked.questionnaire}/${asked.question}`;
  return unit === 'percent' ? null : `${of}/score`;
}

export function isPlanned(measure: MeasureName, plan: PlannedTests): boolean {
  const name = nameInPlan(measure);
  return name !== null && plannedMeasures(plan).includes(name);
}

/** Returns the questionnaire of a measure, and the question or scale of it that is measured; nothing for scores. */
export function askedOf({ asked }: Pick<MeasureName, 'asked'>, plan: Pick<StudyPlan, 'questionnaires'>) {
  const questionnaire = asked ? questionnaireNamed(plan, asked.questionnaire) : undefined;
  return {
    questionnaire,
    question: questionnaire?.questions.find(({ id }) => id === asked?.question),
    scale: questionnaire?.scales.find(({ id }) => id === asked?.question),
  };
}

/** Returns the subject of a question or the name of a scale; empty: none. */
export function aboutOf(measured: MeasureName, plan: Pick<StudyPlan, 'questionnaires'>): string {
  const { question, scale } = askedOf(measured, plan);
  return scale?.label ?? question?.about ?? '';
}

export interface Measure extends MeasureName {
  /**
   * The mean of the counted values of each participant (or group) under each condition, in the order of their codes.
   */
  readonly means: ReadonlyMap<string, ReadonlyMap<string, number>>;
  /** The cohort of everyone with a record, counted or not; empty: the plan has none. */
  readonly cohorts: ReadonlyMap<string, string>;
  /** The values that are not counted. */
  readonly voided: readonly (Exclusion & { readonly condition: string })[];
}

/** Returns the cohort of a participant, equal for all if the plan has none. */
export type CohortOf = (participant: string) => string;

const noCohorts: CohortOf = () => '';

interface Observation {
  readonly who: string;
  readonly participant: string;
  readonly condition: string;
  /** null: without an answer. */
  readonly value: number | null;
  /** Why it is not counted; empty: it is. */
  readonly excluded: string;
}

function measured(name: MeasureName, observations: readonly Observation[], cohortOf: CohortOf): Measure {
  const values = new Map<string, Map<string, number[]>>();
  const cohorts = new Map<string, string>();
  const inOrder = observations.toSorted((a, b) => (a.who < b.who ? -1 : a.who > b.who ? 1 : 0));
  for (const { who, participant, condition, value, excluded } of inOrder) {
    cohorts.set(who, cohortOf(participant));
    if (excluded || value === null) continue;
    const own = values.get(who) ?? new Map<string, number[]>();
    values.set(who, own.set(condition, [...(own.get(condition) ?? []), value]));
  }
  return {
    ...name,
    means: new Map([...values].map(([who, own]) => [who, new Map([...own].map(([id, of]) => [id, meanOf(of)]))])),
    cohorts,
    voided: observations.flatMap(({ participant, condition, excluded }) =>
      excluded ? [{ participant, of: name.of, reason: excluded, condition }] : [],
    ),
  };
}

/** Returns the questions with numeric answers in order, and their names: the id, if it is unique. */
function askedIn(rows: readonly AnswerRow[]): readonly { readonly of: string; readonly asked: QuestionPlace }[] {
  const places = new Map<string, QuestionPlace>();
  for (const { task, questionnaire, question, answer } of rows) {
    const key = `${task}/${questionnaire}/${question}`;
    if (typeof answer === 'number' && !places.has(key)) places.set(key, { task, questionnaire, question });
  }
  const times = new Map<string, number>();
  for (const { question } of places.values()) times.set(question, (times.get(question) ?? 0) + 1);
  return [...places].map(([key, asked]) => ({ of: times.get(asked.question) === 1 ? asked.question : key, asked }));
}

const isOf = (row: AnswerRow, { task, questionnaire, question }: QuestionPlace) =>
  row.question === question && row.questionnaire === questionnaire && row.task === task;

/**
 * Returns every question or scale with numeric answers, measured per participant. Throws if simulated rows and rows of
 * people are mixed.
 */
export function answerMeasures(rows: readonly AnswerRow[], cohortOf: CohortOf = noCohorts): readonly Measure[] {
  rejectMixture(rows);
  return askedIn(rows).map(({ of, asked }) => {
    const own = rows.filter((row) => isOf(row, asked));
    const observations = own.map(({ participant, condition, answer, excluded }) => ({
      who: participant,
      participant,
      condition,
      value: typeof answer === 'number' ? answer : null,
      excluded,
    }));
    return measured({ of, asked, unit: 'answer' }, observations, cohortOf);
  });
}

/**
 * Returns the scores of every task in points or in per cent of the maximum, as means of a block's trials. A group has
 * one value, measured as "group 01". Throws if simulated rows and rows of people are mixed.
 */
export function scoreMeasures(
  rows: readonly TrialRow[],
  unit: 'points' | 'percent',
  cohortOf: CohortOf = noCohorts,
): readonly Measure[] {
  rejectMixture(rows);
  // Practice has no condition.
  const played = rows.filter(({ condition }) => condition);
  return [...new Set(played.map(({ task }) => task))].map((task) => {
    const own = played.filter((row) => row.task === task);
    const digits = String(Math.max(...own.map(({ group }) => group))).length;
    const named = own.map(({ participant, group, condition, repetition, score, maximum, excluded }) => ({
      who: `group ${String(group).padStart(digits, '0')}`,
      participant,
      condition: condition as string,
      repetition,
      value: unit === 'points' ? score : (100 * score) / maximum,
      excluded,
    }));
    // The members of a group report the same score.
    const counted = new Map(
      named.filter(({ excluded }) => !excluded).map((row) => [`${row.who} ${row.condition} ${row.repetition}`, row]),
    );
    const observations = [...named.filter(({ excluded }) => excluded), ...counted.values()];
    return measured({ of: task, asked: null, unit }, observations, cohortOf);
  });
}
