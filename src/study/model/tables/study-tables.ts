import { cohortsByParticipant } from '../plan/allocation';
import type { StudyPlan } from '../plan/plan';
import type { Place, StudyEvent, StudyRecord } from '../records/study-record';
import { type AnswerRow, answerRows, type BlockExclusion, questionTable, scaleRows, scaleTable } from './answer-tables';
import { conditionTable } from './condition-table';
import { plannedTable } from './planned-table';
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
import type { Cell, Table } from './tidy-csv';

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

const identity = ({ study, participant, simulated }: StudyRecord) => ({ study, participant, simulated });
const placed = ({ task, block, run }: Place) => ({ task, block, run });

/** Returns the answers to every question, with voided ones marked. */
export const answersIn = (records: readonly StudyRecord[], plan: StudyPlan): readonly AnswerRow[] =>
  answerRows(records, plan, voidedBlocks(records));

/** Returns the scales that are computed from the answers, with voided ones marked. */
export const scalesIn = (records: readonly StudyRecord[], plan: StudyPlan): readonly AnswerRow[] =>
  scaleRows(records, plan, voidedBlocks(records));

function trialRows(records: readonly StudyRecord[], exclusion: BlockExclusion) {
  return records.flatMap((record) => {
    if (record.kind !== 'trial') return [];
    const { place, condition, estimator, repetition, group, outcome } = record.body;
    const excluded = exclusion(record.participant, place) || (condition === null ? 'tutorial' : '');
    const common = {
      ...identity(record),
      ...placed(place),
      attempt: place.attempt,
      condition,
      estimator,
      repetition,
      excluded,
    };
    return [{ common, group, at: record.at, outcome }];
  });
}

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
  trialRows(records, voidedBlocks(records)).map(({ common, group, outcome }) => ({
    ...common,
    group,
    score: outcome.score,
    maximum: outcome.maximum,
  }));

function participantRows(records: readonly StudyRecord[], plan: StudyPlan) {
  const cohorts = cohortsByParticipant(plan);
  const rows = new Map<string, Record<string, Cell>>();
  for (const record of records) {
    let row = rows.get(record.participant);
    if (!row) {
      row = Object.fromEntries(participantColumns.map(({ name }) => [name, null]));
      Object.assign(row, identity(record), { cohort: cohorts.get(record.participant)?.id ?? null });
      rows.set(record.participant, row);
    }
    if (record.kind === 'consent') {
      const { version, motion, language = null } = record.body;
      Object.assign(row, { consent_version: version, motion_consent: motion, language });
    } else if (record.kind === 'demographics') {
      const { vrExperience, vrSystems, ...rest } = record.body;
      Object.assign(row, { ...rest, vr_experience: vrExperience, vr_systems: vrSystems });
    }
  }
  return [...rows.values()];
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

function eventRows(records: readonly StudyRecord[]) {
  return records.flatMap((record) => {
    if (record.kind !== 'event') return [];
    const { body } = record;
    const place = 'place' in body ? body.place : body.type === 'void-block' ? body : null;
    return [
      {
        ...identity(record),
        event: body.type,
        task: place?.task ?? null,
        block: place?.block ?? null,
        run: place?.run ?? null,
        text: saidIn(body),
        at: record.at,
      },
    ];
  });
}

/** Throws if simulated records and records of people are mixed, because no table may contain both. */
export function refuseMixture(records: readonly { readonly simulated: boolean }[]): void {
  if (records.some(({ simulated }) => simulated) && records.some(({ simulated }) => !simulated)) {
    throw new Error('simulated records and records of people must not be mixed');
  }
}

/** Returns a row of the table `trials`. */
const trialTableRow = ({ common, group, at, outcome }: ReturnType<typeof trialRows>[number]) => ({
  ...common,
  group,
  ended: outcome.ended,
  score: outcome.score,
  maximum: outcome.maximum,
  percent: (100 * outcome.score) / outcome.maximum,
  shots: outcome.shots,
  hits: outcome.hits,
  seconds: outcome.seconds,
  frames: outcome.frames.count,
  missed_frames: outcome.frames.missed,
  device: outcome.device.name,
  refresh_rate: outcome.device.refreshRateHz,
  input: outcome.device.input,
  eye_height: outcome.calibration?.eyeHeight ?? null,
  arm_span: outcome.calibration?.armSpan ?? null,
  forearm: outcome.calibration?.forearm ?? null,
  gaze_pitch: outcome.calibration?.gazePitch ?? null,
  left_hand_pitch: outcome.calibration?.handTilts?.left?.pitch ?? null,
  left_hand_yaw: outcome.calibration?.handTilts?.left?.yaw ?? null,
  right_hand_pitch: outcome.calibration?.handTilts?.right?.pitch ?? null,
  right_hand_yaw: outcome.calibration?.handTilts?.right?.yaw ?? null,
  head_losses: outcome.tracking.head.losses,
  head_lost: outcome.tracking.head.seconds,
  left_hand_losses: outcome.tracking.leftHand.losses,
  left_hand_lost: outcome.tracking.leftHand.seconds,
  right_hand_losses: outcome.tracking.rightHand.losses,
  right_hand_lost: outcome.tracking.rightHand.seconds,
  assists: outcome.assists.join('; '),
  motion_frames: outcome.motionFrames,
  started: outcome.clock?.epoch ?? null,
  recording_start: outcome.clock?.start ?? null,
  at,
});

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
      rows: answerRows(records, plan, exclusion).map(({ answer, ...row }) => ({
        ...row,
        answer: typeof answer === 'number' ? answer : null,
        answer_text: typeof answer === 'string' ? answer : '',
      })),
    },
    questionTable(plan),
    {
      name: 'scales',
      columns: scaleColumns,
      rows: scaleRows(records, plan, exclusion).map(({ question, answer, ...row }) => ({
        ...row,
        scale: question,
        value: answer,
      })),
    },
    scaleTable(plan),
    {
      name: 'trials',
      columns: trialColumns,
      rows: trials.map(trialTableRow),
    },
    {
      name: 'frame-times',
      columns: frameTimeColumns,
      rows: trials.flatMap(({ common, outcome }) =>
        Object.entries(outcome.frames.stages).map(([stage, { count, minMs, maxMs, meanMs, p50Ms, p95Ms }]) => ({
          ...common,
          stage,
          count,
          min: minMs,
          max: maxMs,
          mean: meanMs,
          p50: p50Ms,
          p95: p95Ms,
        })),
      ),
    },
    {
      name: 'hits',
      columns: hitColumns,
      rows: trials.flatMap(({ common, outcome }) =>
        outcome.events.map(({ onset = null, ...event }) => ({ ...common, ...event, onset })),
      ),
    },
    {
      name: 'pauses',
      columns: pauseColumns,
      rows: trials.flatMap(({ common, outcome }) =>
        (outcome.clock?.pauses ?? []).map((pause) => ({ ...common, ...pause })),
      ),
    },
    { name: 'events', columns: eventColumns, rows: eventRows(records) },
  ];
}
