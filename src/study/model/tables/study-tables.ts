import { cohortsByParticipant } from '../plan/allocation';
import { languagesOf, type StudyPlan } from '../plan/plan';
import type { Answer } from '../questionnaires/question-kind';
import { scaleScore } from '../questionnaires/questionnaire-scores';
import { type Answers, type Questionnaire, questionnaireNamed } from '../questionnaires/questionnaires';
import type { Place, StoredRecord, StudyEvent, StudyRecord, TrialRecord } from '../records/study-record';
import { incompleteReason, type TrialAbsence } from '../records/trial-log';
import { conditionTable, plannedTable, questionTable, scaleTable } from './plan-tables';
import { recordFlags } from './record-flags';
import {
  answerColumns,
  eventColumns,
  frameTimeColumns,
  hitColumns,
  participantColumns,
  pauseColumns,
  scaleColumns,
  trialColumns,
} from './study-columns';
import { rowFrom, type Table } from './tidy-csv';

/** Returns a function to the reason why the records of a block are not counted, "voided: …"; empty: they are. */
export function voidedBlocks(records: readonly StudyRecord[]): (participant: string, place: Place) => string {
  const key = (participant: string, { task, block, run }: Pick<Place, 'task' | 'block' | 'run'>) =>
    `${participant} ${task}/${block}@${run}`;
  const voided = new Map<string, string>();
  for (const record of records) {
    if (record.kind === 'event' && record.body.type === 'void-block') {
      voided.set(key(record.participant, record.body), `voided: ${record.body.reason}`);
    }
  }
  return (participant, place) => voided.get(key(participant, place)) ?? '';
}

/** An answer to a question, or the value of a scale. */
export interface AnswerRow {
  readonly participant: string;
  readonly simulated: boolean;
  readonly task: string;
  readonly condition: string;
  readonly questionnaire: string;
  /** The id of the question or of the scale. */
  readonly question: string;
  /** null: without an answer, or without one that the scale needs. */
  readonly answer: Answer | null;
  /** Why it is not counted; empty: it is. */
  readonly excluded: string;
}

function rowsOf(
  records: readonly StudyRecord[],
  plan: StudyPlan,
  valuesOf: (asked: Questionnaire, answers: Answers) => readonly (readonly [string, Answer | null])[],
) {
  const exclusionOf = voidedBlocks(records);
  return records.flatMap((record) => {
    if (record.kind !== 'answers') return [];
    const { participant, simulated } = record;
    const { place, answers, condition, questionnaire } = record.body;
    const asked = questionnaireNamed(plan, questionnaire);
    if (!asked)
      throw new Error(`${participant} answered "${questionnaire}", which the plan "${plan.id}" does not hold`);
    const excluded = exclusionOf(participant, place);
    return valuesOf(asked, answers).map(([question, answer]) => ({
      ...{ record, participant, simulated, task: place.task, condition, questionnaire, question, answer, excluded },
    }));
  });
}

type FlagOf = ReturnType<typeof recordFlags>;

/** Returns a row with its record for every question of every submitted questionnaire, with voided ones marked. */
export const answersIn = (records: readonly StudyRecord[], plan: StudyPlan) =>
  rowsOf(records, plan, ({ questions }, answers) => questions.map(({ id }) => [id, answers[id] ?? null]));

/** Returns a row with its record for every scale of every submitted questionnaire, with voided ones marked. */
export const scalesIn = (records: readonly StudyRecord[], plan: StudyPlan) =>
  rowsOf(records, plan, (asked, answers) => asked.scales.map((scale) => [scale.id, scaleScore(asked, scale, answers)]));

/** A trial with its scores; voided ones, tutorials and incomplete ones are marked. */
export interface TrialRow {
  readonly participant: string;
  readonly simulated: boolean;
  readonly task: string;
  /** null: a tutorial. */
  readonly condition: string | null;
  readonly repetition: number;
  readonly group: number;
  readonly score: number;
  readonly maximum: number;
  /** Why it is not counted; empty: it is. */
  readonly excluded: string;
}

/** Returns a row with its record for every trial and tutorial. */
export function trialsIn(records: readonly StudyRecord[]): readonly (TrialRow & { readonly record: TrialRecord })[] {
  const exclusionOf = voidedBlocks(records);
  return records.flatMap((record) => {
    if (record.kind !== 'trial') return [];
    const { participant, simulated } = record;
    const { place, condition, repetition, group, outcome } = record.body;
    const { score, maximum } = outcome;
    const excluded = exclusionOf(participant, place) || (condition === null ? 'tutorial' : incompleteReason(outcome));
    return { record, participant, simulated, task: place.task, condition, repetition, group, score, maximum, excluded };
  });
}

function participantRows(records: readonly StoredRecord[], plan: StudyPlan, flagOf: FlagOf) {
  const cohorts = cohortsByParticipant(plan);
  const people = new Map<string, { readonly first: StoredRecord; readonly body: object }>();
  for (const record of records) {
    const known = people.get(record.participant) ?? { first: record, body: {} };
    if (record.kind === 'consent' || record.kind === 'demographics') Object.assign(known.body, record.body);
    if (record.kind === 'event' && record.body.type === 'motion-withdrawn')
      Object.assign(known.body, { motion: false });
    people.set(record.participant, known);
  }
  return [...people].map(([participant, { first, body }]) => {
    const computed = { cohort: cohorts.get(participant)?.id ?? null, flag: flagOf(first) };
    return rowFrom(participantColumns, { ...first, body }, computed);
  });
}

const absenceText = ({ participants, time, seconds, givenUp }: TrialAbsence): string =>
  `${participants.join(' ')}: ${seconds.toFixed(1)} s at second ${time.toFixed(1)}${givenUp ? ', given up' : ''}`;

function eventText(body: StudyEvent): string {
  switch (body.type) {
    case 'remark':
      return body.text;
    case 'void-block':
      return body.reason;
    case 'stop':
      return [`by the ${body.by}`, body.reason].filter(Boolean).join(': ');
    case 'absence':
      return absenceText(body);
    case 'pause':
    case 'resume':
      return `by the ${body.by}`;
    case 'unwell':
      return `${body.questionnaire} ${body.measure}: ${body.value}`;
    default:
      return '';
  }
}

const eventRows = (records: readonly StoredRecord[], flagOf: FlagOf) =>
  records.flatMap((record) => {
    if (record.kind !== 'event') return [];
    const { body } = record;
    const place = 'place' in body ? body.place : body.type === 'void-block' ? body : null;
    const { task = null, block = null, run = null } = place ?? {};
    const length = body.type === 'absence' ? { second: body.time, seconds: body.seconds } : {};
    const computed = { task, block, run, text: eventText(body), flag: flagOf(record) };
    return [rowFrom(eventColumns, record, { ...computed, second: null, seconds: null, ...length })];
  });

/** Throws if simulated records and records of people are mixed, because no table may contain both. */
export function rejectMixture(records: readonly { readonly simulated: boolean }[]): void {
  if (records.some(({ simulated }) => simulated) && records.some(({ simulated }) => !simulated)) {
    throw new Error('simulated records and records of people must not be mixed');
  }
}

/** Returns the tables of an export. Throws if simulated records and records of people are mixed. */
export function studyTables(records: readonly StoredRecord[], plan: StudyPlan): readonly Table[] {
  rejectMixture(records);
  const flagOf = recordFlags(records);
  const trials = trialsIn(records);
  return [
    { name: 'participants', columns: participantColumns, rows: participantRows(records, plan, flagOf) },
    conditionTable(plan),
    plannedTable(plan),
    {
      name: 'answers',
      columns: answerColumns,
      rows: answersIn(records, plan).map(({ record, question, answer, excluded }) => {
        const { language = languagesOf(plan)[0] } = record.body;
        const given = typeof answer === 'string' ? { answer: null, answer_text: answer } : { answer, answer_text: '' };
        return rowFrom(answerColumns, record, { question, ...given, language, excluded, flag: flagOf(record) });
      }),
    },
    questionTable(plan),
    {
      name: 'scales',
      columns: scaleColumns,
      rows: scalesIn(records, plan).map(({ record, question, answer, excluded }) =>
        rowFrom(scaleColumns, record, { scale: question, value: answer, excluded, flag: flagOf(record) }),
      ),
    },
    scaleTable(plan),
    {
      name: 'trials',
      columns: trialColumns,
      rows: trials.map(({ record, score, maximum, excluded }) => {
        const { assists, absences = [] } = record.body.outcome;
        return rowFrom(trialColumns, record, {
          percent: (100 * score) / maximum,
          assists: assists.join('; '),
          absences: absences.map(absenceText).join('; '),
          absent_seconds: absences.reduce((sum, absence) => sum + absence.seconds, 0),
          excluded,
          flag: flagOf(record),
        });
      }),
    },
    {
      name: 'frame-times',
      columns: frameTimeColumns,
      rows: trials.flatMap(({ record, excluded }) =>
        Object.entries(record.body.outcome.frames.stages).map(([stage, summary]) =>
          rowFrom(frameTimeColumns, record, { stage, excluded, flag: flagOf(record) }, summary),
        ),
      ),
    },
    {
      name: 'hits',
      columns: hitColumns,
      rows: trials.flatMap(({ record, excluded }) =>
        record.body.outcome.events.map((event) =>
          rowFrom(hitColumns, record, { excluded, flag: flagOf(record) }, event),
        ),
      ),
    },
    {
      name: 'pauses',
      columns: pauseColumns,
      rows: trials.flatMap(({ record, excluded }) =>
        (record.body.outcome.clock?.pauses ?? []).map((pause) =>
          rowFrom(pauseColumns, record, { excluded, flag: flagOf(record) }, pause),
        ),
      ),
    },
    { name: 'events', columns: eventColumns, rows: eventRows(records, flagOf) },
  ];
}
