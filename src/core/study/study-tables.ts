import { cohortsByParticipant } from './allocation';
import { type AnswerRow, answerRows, type BlockExclusion, questionTable, scaleRows, scaleTable } from './answer-tables';
import { conditionTable } from './condition-table';
import type { StudyPlan } from './plan';
import type { Place, StudyRecord } from './study-record';
import { boolean, type Cell, number, type Table, text } from './tidy-csv';

const who = [
  text('study', 'Id of the study.'),
  text('participant', 'Code of the participant.'),
  boolean('simulated', 'TRUE: made by a program. Never analyse together with people.'),
];
const where = [
  text('task', 'Id of the task.'),
  number('block', '', 'Place of the condition in the order of this participant, from 1.'),
  number('run', '', 'From 1; a block that was voided and repeated runs again.'),
];
const conditionColumns = [
  text('condition', 'Id of the condition; empty: tutorial.'),
  text('estimator', 'Method that drew the body.'),
];
const excluded = text('excluded', 'Why the row counts for nothing: "voided: reason" or "tutorial"; empty: it counts.');
const time = number('at', 's', 'When, in seconds since 1970-01-01 UTC, by the clock of the device.');

const participantColumns = [
  ...who,
  text('cohort', 'Id of the cohort; empty: the study has none.'),
  text('consent_version', 'Version of the text consented to.'),
  boolean('motion_consent', 'Whether tracked frames may be kept.'),
  text('language', 'In which the text was read; empty: the study has only one.'),
  text('gender', 'woman, man, non-binary, other, not-said.'),
  number('age', 'years', 'As told.'),
  text('major', 'Field of study or work, as typed.'),
  text('vr_experience', 'none, once-or-twice, several-times, monthly, weekly.'),
  text('vr_systems', 'Systems used before, as typed.'),
  text('handedness', 'right, left, both.'),
  text('vision', 'normal, corrected, impaired.'),
];

const answerColumns = [
  ...who,
  ...where,
  ...conditionColumns,
  text('questionnaire', 'Id.'),
  text('question', 'Id of the question; its words and its scale are in questions.csv.'),
  number('answer', '', 'As given, reversed questions too; empty: text, a choice, or left open.'),
  text('answer_text', 'Text as typed, or the value of the option chosen; empty: a number, or left open.'),
  text('language', 'In which it was read.'),
  number('seconds', 's', 'From the first question shown to handing in the whole questionnaire, pauses left out.'),
  boolean('overtime', 'Whether that took longer than the plan gives.'),
  time,
  excluded,
];

const scaleColumns = [
  ...who,
  ...where,
  ...conditionColumns,
  text('questionnaire', 'Id.'),
  text('scale', 'Id of the scale; scale-definitions.csv says how it is computed.'),
  number('value', '', 'Empty: a question that it needs has no answer.'),
  time,
  excluded,
];

const attempt = number('attempt', '', 'From 1; a trial lost by a crash or reload is tried again.');

/** Which trial a row belongs to. */
const trialNames = [
  ...who,
  ...where,
  attempt,
  ...conditionColumns,
  number('repetition', '', 'Trial of the block, from 1.'),
];

const trialColumns = [
  ...trialNames,
  number('group', '', 'Number of the group; tasks played alone: of the participant.'),
  text('ended', 'arrows, targets, balls, time, or stopped (early).'),
  number('score', 'points', "In a group the group's."),
  number('maximum', 'points', 'The most that can be had.'),
  number('percent', '%', '100 score / maximum.'),
  number('shots', '', 'Arrows or balls sent off by this participant.'),
  number('hits', '', 'How many of them counted.'),
  number('seconds', 's', 'From the start signal to the end.'),
  number('frames', '', 'Frames drawn.'),
  number('missed_frames', '', 'Frames shown later than the device wanted.'),
  text('device', 'Name of the headset or browser.'),
  number('refresh_rate', 'Hz', 'Frames per second that the device wants; empty: unknown.'),
  text('input', 'controllers, hands, mixed, emulated, simulated.'),
  number('eye_height', 'm', 'Calibration: height of the eyes above the floor.'),
  number('arm_span', 'm', 'Calibration: from wrist to wrist, arms sideways.'),
  number('forearm', 'm', 'Calibration: from elbow to wrist; empty: not told.'),
  number(
    'gaze_pitch',
    'rad',
    'Calibration: how far up the headset points when its wearer looks ahead; empty: not measured.',
  ),
  ...(['left', 'right'] as const).flatMap((side) => [
    number(
      `${side}_hand_pitch`,
      'rad',
      `Calibration: how far up of its ${side} hand the forearm points; empty: not measured.`,
    ),
    number(`${side}_hand_yaw`, 'rad', `Calibration: how far to the left of its ${side} hand; empty: not measured.`),
  ]),
  number('head_losses', '', 'How often the head was not tracked.'),
  number('head_lost', 's', 'For how long.'),
  number('left_hand_losses', '', 'How often the left hand was not tracked.'),
  number('left_hand_lost', 's', 'For how long.'),
  number('right_hand_losses', '', 'How often the right hand was not tracked.'),
  number('right_hand_lost', 's', 'For how long.'),
  text('assists', 'Aids that were on, divided by semicolons.'),
  number('motion_frames', '', 'Tracked frames recorded beside this.'),
  number('started', 's', 'Second 0, in seconds since 1970-01-01 UTC, by the clock of the device; empty: not known.'),
  number(
    'recording_start',
    's',
    'Second 0 on the clock of the recorded frames, which runs on in pauses (pauses.csv); empty: not known.',
  ),
  time,
  excluded,
];

const frameTimeColumns = [
  ...trialNames,
  text('stage', 'Stage of the frame; "frame" is all of its work.'),
  number('count', '', 'Frames measured.'),
  number('min', 'ms', 'Shortest.'),
  number('max', 'ms', 'Longest.'),
  number('mean', 'ms', 'Mean.'),
  number('p50', 'ms', 'Median.'),
  number('p95', 'ms', '95th percentile.'),
  excluded,
];

const hitColumns = [
  ...trialNames,
  number('time', 's', "Second of the game's own clock, which also stands while the head is lost."),
  number(
    'onset',
    's',
    'Second of the trial at the frame that showed it; with recording_start and the pauses before it, its place among recorded frames. Empty: not known.',
  ),
  text('type', 'hit, miss, catch.'),
  number('points', 'points', 'What it scored.'),
  excluded,
];

const pauseColumns = [
  ...trialNames,
  number('time', 's', 'Second of the trial at which it stood.'),
  number('seconds', 's', 'For how long.'),
  excluded,
];

const eventColumns = [
  ...who,
  text('event', 'void-block, interrupted, pause, resume, remark, reload, finished.'),
  text('task', 'Where it concerns one; empty: no particular one.'),
  number('block', '', 'Where it concerns one.'),
  number('run', '', 'Where it concerns one.'),
  text('text', 'Remark or reason, as typed.'),
  time,
];

/** Says why what was recorded at a place counts for nothing: "voided: reason"; empty: it counts. */
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

/** The answers to every question, voided ones marked. */
export const answersIn = (records: readonly StudyRecord[], plan: StudyPlan): readonly AnswerRow[] =>
  answerRows(records, plan, voidedBlocks(records));

/** The scales that are computed from the answers, voided ones marked. */
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

/** Trials with their scores, voided ones and tutorials marked. */
export interface TrialRow {
  readonly participant: string;
  readonly simulated: boolean;
  readonly task: string;
  readonly condition: string | null;
  readonly repetition: number;
  readonly group: number;
  readonly score: number;
  readonly maximum: number;
  /** Empty: it counts. */
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

function eventRows(records: readonly StudyRecord[]) {
  return records.flatMap((record) => {
    if (record.kind !== 'event') return [];
    const { body } = record;
    const place = body.type === 'interrupted' ? body.place : body.type === 'void-block' ? body : null;
    const said = body.type === 'remark' ? body.text : body.type === 'void-block' ? body.reason : '';
    return [
      {
        ...identity(record),
        event: body.type,
        task: place?.task ?? null,
        block: place?.block ?? null,
        run: place?.run ?? null,
        text: said,
        at: record.at,
      },
    ];
  });
}

/** Simulated records are never put into one table with those of people: throws where both are given. */
export function refuseMixture(records: readonly { readonly simulated: boolean }[]): void {
  if (records.some(({ simulated }) => simulated) && records.some(({ simulated }) => !simulated)) {
    throw new Error('simulated records and records of people must not be mixed');
  }
}

/** A row of the table `trials`. */
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

/** The tables of an export. Throws where simulated records and records of people are mixed. */
export function studyTables(records: readonly StudyRecord[], plan: StudyPlan): readonly Table[] {
  refuseMixture(records);
  const exclusion = voidedBlocks(records);
  const trials = trialRows(records, exclusion);
  return [
    { name: 'participants', columns: participantColumns, rows: participantRows(records, plan) },
    conditionTable(plan),
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
