import { cohortsByParticipant } from '../plan/allocation';
import { languagesOf, type StudyPlan } from '../plan/plan';
import type { Place, StudyEvent, StudyRecord } from '../records/study-record';
import { type AnswerRow, answerRows, type BlockExclusion, questionTable, scaleRows, scaleTable } from './answer-tables';
import { conditionTable, plannedTable } from './condition-table';
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

/**
 * Returns a function that gives the reason why the records of a block are not counted, "voided: reason", or an empty
 * text.
 */
export function voidedBlocks(records: readonly StudyRecord[]): BlockExclusion {
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

/** Returns the answers to every question, with voided ones marked. */
export const answersIn = (records: readonly StudyRecord[], plan: StudyPlan): readonly AnswerRow[] =>
  answerRows(records, plan, voidedBlocks(records));

/** Returns the scales that are computed from the answers, with voided ones marked. */
export const scalesIn = (records: readonly StudyRecord[], plan: StudyPlan): readonly AnswerRow[] =>
  scaleRows(records, plan, voidedBlocks(records));

const trialRows = (records: readonly StudyRecord[], exclusion: BlockExclusion) =>
  records.flatMap((record) => {
    if (record.kind !== 'trial') return [];
    const { place, condition } = record.body;
    const excluded = exclusion(record.participant, place) || (condition === null ? 'tutorial' : '');
    return [{ record, outcome: record.body.outcome, excluded }];
  });

/** A trial with its scores; voided ones and tutorials are marked. */
export interface TrialRow {
  readonly participant: string;
  readonly simulated: boolean;
  readonly task: string;
  readonly condition: string | null;
  readonly repetition: number;
  readonly group: number;
  readonly score: number;
  readonly maximum: number;
  /** Empty: it is counted. */
  readonly excluded: string;
}

export const trialsIn = (records: readonly StudyRecord[]): readonly TrialRow[] =>
  trialRows(records, voidedBlocks(records)).map(({ record, outcome, excluded }) => {
    const { place, condition, repetition, group } = record.body;
    const { participant, simulated } = record;
    const { score, maximum } = outcome;
    return { participant, simulated, task: place.task, condition, repetition, group, score, maximum, excluded };
  });

function participantRows(records: readonly StudyRecord[], plan: StudyPlan) {
  const cohorts = cohortsByParticipant(plan);
  const people = new Map<string, Pick<StudyRecord, 'study' | 'participant' | 'simulated'> & { body: object }>();
  for (const record of records) {
    const { study, participant, simulated } = record;
    const known = people.get(participant) ?? { study, participant, simulated, body: {} };
    if (record.kind === 'consent' || record.kind === 'demographics') Object.assign(known.body, record.body);
    people.set(participant, known);
  }
  return [...people.values()].map((one) =>
    rowFrom(participantColumns, one, { cohort: cohorts.get(one.participant)?.id ?? null }),
  );
}

/** Returns the text of an event. */
function saidIn(body: StudyEvent): string {
  switch (body.type) {
    case 'remark':
      return body.text;
    case 'void-block':
      return body.reason;
    case 'stop':
      return [`by the ${body.by}`, body.reason].filter(Boolean).join(': ');
    case 'unwell':
      return `${body.questionnaire} ${body.measure}: ${body.value}`;
    default:
      return '';
  }
}

const eventRows = (records: readonly StudyRecord[]) =>
  records.flatMap((record) => {
    if (record.kind !== 'event') return [];
    const { body } = record;
    const place = 'place' in body ? body.place : body.type === 'void-block' ? body : null;
    const { task = null, block = null, run = null } = place ?? {};
    return [rowFrom(eventColumns, record, { task, block, run, text: saidIn(body) })];
  });

/** Throws if simulated records and records of people are mixed, because no table may contain both. */
export function refuseMixture(records: readonly { readonly simulated: boolean }[]): void {
  if (records.some(({ simulated }) => simulated) && records.some(({ simulated }) => !simulated)) {
    throw new Error('simulated records and records of people must not be mixed');
  }
}

/** Returns the tables of an export. Throws if simulated records and records of people are mixed. */
export function studyTables(records: readonly StudyRecord[], plan: StudyPlan): readonly Table[] {
  refuseMixture(records);
  const exclusion = voidedBlocks(records);
  const trials = trialRows(records, exclusion);
  return [
    { name: 'participants', columns: participantColumns, rows: participantRows(records, plan) },
    conditionTable(plan),
    plannedTable(plan),
    {
      name: 'answers',
      columns: answerColumns,
      rows: answerRows(records, plan, exclusion).map(({ record, question, answer, excluded }) => {
        const { language = languagesOf(plan)[0] } = record.body;
        const given = typeof answer === 'string' ? { answer: null, answer_text: answer } : { answer, answer_text: '' };
        return rowFrom(answerColumns, record, { question, ...given, language, excluded });
      }),
    },
    questionTable(plan),
    {
      name: 'scales',
      columns: scaleColumns,
      rows: scaleRows(records, plan, exclusion).map(({ record, question, answer, excluded }) =>
        rowFrom(scaleColumns, record, { scale: question, value: answer, excluded }),
      ),
    },
    scaleTable(plan),
    {
      name: 'trials',
      columns: trialColumns,
      rows: trials.map(({ record, outcome, excluded }) => {
        const percent = (100 * outcome.score) / outcome.maximum;
        return rowFrom(trialColumns, record, { percent, assists: outcome.assists.join('; '), excluded });
      }),
    },
    {
      name: 'frame-times',
      columns: frameTimeColumns,
      rows: trials.flatMap(({ record, outcome, excluded }) =>
        Object.entries(outcome.frames.stages).map(([stage, summary]) =>
          rowFrom(frameTimeColumns, record, { stage, excluded }, summary),
        ),
      ),
    },
    {
      name: 'hits',
      columns: hitColumns,
      rows: trials.flatMap(({ record, outcome, excluded }) =>
        outcome.events.map((event) => rowFrom(hitColumns, record, { excluded }, event)),
      ),
    },
    {
      name: 'pauses',
      columns: pauseColumns,
      rows: trials.flatMap(({ record, outcome, excluded }) =>
        (outcome.clock?.pauses ?? []).map((pause) => rowFrom(pauseColumns, record, { excluded }, pause)),
      ),
    },
    { name: 'events', columns: eventColumns, rows: eventRows(records) },
  ];
}
