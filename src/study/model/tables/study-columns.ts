import { threePointNames } from 'threepoint/core';
import { type Demographics, demographicFields } from '../records/demographics';
import { eventTypes } from '../records/study-record';
import { trialEnds } from '../records/trial-log';
import { boolean, number, text } from './tidy-csv';

const ordinals = '1, 2, 3 …';
const counts = '0, 1, 2 …';
const positive = '0 and more';
const ids = 'small letters, digits, hyphens';
const codes = 'letters, digits, - and _';
const tag = 'a language tag';
const moment = 'since 1970-01-01 UTC';
const methods = threePointNames.join(', ');

const who = [
  text('study', ids, 'records: study', 'Id of the study.'),
  text('participant', 'P01 to P999', 'records: participant', 'Code of the participant.'),
  boolean('simulated', 'records: simulated', 'TRUE: made by a program. Never analyse together with people.'),
  text(
    'author',
    'participant, experimenter',
    'records: author',
    'Whose token the record came with; empty: no server has stored it.',
  ),
  text(
    'flag',
    'clock, repeated, run, hits, divided by semicolons',
    'computed from all records',
    'Why the row is doubtful: at is after its receipt or a year before it; a second result of the same trial or questionnaire; a run without enough voided blocks; more hits than shots. Empty: it is not.',
  ),
];
const blockMeaning = 'Place of the condition in the order of this participant, from 1.';
const runMeaning = 'From 1; a block that was voided and repeated runs again.';
const where = [
  text('task', ids, 'body.place.task', 'Id of the task.'),
  number('block', '', ordinals, 'body.place.block', blockMeaning),
  number('run', '', ordinals, 'body.place.run', runMeaning),
];
const conditionColumns = [
  text('condition', ids, 'body.condition', 'Id of the condition; empty: tutorial.'),
  text('estimator', methods, 'body.estimator', 'Estimator of the body.'),
];
const excluded = text(
  'excluded',
  'voided: reason; tutorial; incomplete: reason',
  'void-block events of the same task, block and run; tutorials have no condition; trials of which ended is absence, or that have from, are incomplete',
  'Why the row is not counted; empty: it is.',
);
const times = [
  number('at', 's', moment, 'records: at', 'Time by the clock of the device.'),
  number('received', 's', moment, 'records: receivedAt', 'Time of receipt by the clock of the server.'),
];

/** Returns the options of a question about the participant. */
function optionsOf(id: keyof Demographics): string {
  const field = demographicFields.find((one) => one.id === id);
  return field?.kind === 'choice' ? field.options.map(({ value }) => value).join(', ') : 'any text';
}

export const participantColumns = [
  ...who,
  text('cohort', ids, 'drawn from the seed in plan.json', 'Id of the cohort; empty: the study has none.'),
  text('consent_version', 'any text', 'consent: body.version', 'Version of the text consented to.'),
  boolean(
    'motion_consent',
    'consent: body.motion',
    'Whether tracked frames may be kept; FALSE after a withdrawal of that.',
  ),
  text('language', tag, 'consent: body.language', 'Language of the text; empty: the study has only one.'),
  text('gender', optionsOf('gender'), 'demographics: body.gender', 'As stated.'),
  number('age', 'years', '16 to 120', 'demographics: body.age', 'As stated.'),
  text('major', 'any text', 'demographics: body.major', 'Field of study or work, as typed.'),
  text('vr_experience', optionsOf('vrExperience'), 'demographics: body.vrExperience', 'Use of virtual reality before.'),
  text('vr_systems', 'any text', 'demographics: body.vrSystems', 'Systems used before, as typed.'),
  text('handedness', optionsOf('handedness'), 'demographics: body.handedness', 'Preferred hand, as stated.'),
  text('vision', optionsOf('vision'), 'demographics: body.vision', 'As stated.'),
];

const languageRead = 'Language of the questionnaire; the first of the plan if the record has none.';

export const answerColumns = [
  ...who,
  ...where,
  ...conditionColumns,
  text('questionnaire', ids, 'answers: body.questionnaire', 'Id.'),
  text('question', codes, 'answers: body.answers', 'Id; its text and its scale are in questions.csv.'),
  number(
    'answer',
    '',
    'as questions.csv says',
    'answers: body.answers',
    'As given, reversed questions too; empty: text, a choice, or left open.',
  ),
  text(
    'answer_text',
    'an option of questions.csv, or any text',
    'answers: body.answers',
    'Text as typed, or the value of the option chosen; empty: a number, or left open.',
  ),
  text('language', tag, 'answers: body.language', languageRead),
  number(
    'seconds',
    's',
    positive,
    'answers: body.seconds',
    'From the first question shown to handing in the whole questionnaire, pauses left out.',
  ),
  boolean('overtime', 'answers: body.overtime', 'Whether that took longer than the time limit in the plan.'),
  ...times,
  excluded,
];

export const scaleColumns = [
  ...who,
  ...where,
  ...conditionColumns,
  text('questionnaire', ids, 'answers: body.questionnaire', 'Id.'),
  text('scale', codes, 'plan.json: scales of the questionnaire', 'Id; scale-definitions.csv has its computation.'),
  number(
    'value',
    '',
    'from and to in scale-definitions.csv',
    'computed from answers: body.answers',
    'Empty: a question that it needs has no answer.',
  ),
  ...times,
  excluded,
];

/** The columns that identify the trial of a row. */
const trialNames = [
  ...who,
  ...where,
  number(
    'attempt',
    '',
    ordinals,
    'body.place.attempt',
    'From 1; after a crash or reload another one begins, in a match of a group the rest of that match.',
  ),
  ...conditionColumns,
  number('repetition', '', ordinals, 'trial: body.repetition', 'Trial of the block, from 1.'),
];

const outcome = (path: string) => `trial: body.outcome.${path}`;
const measured = (path: string) => outcome(`calibration.${path}`);
const lossNames = { head: 'head', leftHand: 'left hand', rightHand: 'right hand' } as const;

const lossColumns = (part: keyof typeof lossNames) => {
  const name = lossNames[part];
  const column = name.replace(' ', '_');
  return [
    number(
      `${column}_losses`,
      '',
      counts,
      outcome(`tracking.${part}.losses`),
      `Number of tracking losses of the ${name}.`,
    ),
    number(
      `${column}_lost`,
      's',
      positive,
      outcome(`tracking.${part}.seconds`),
      `Duration of all tracking losses of the ${name}.`,
    ),
  ];
};

const tiltColumns = (side: 'left' | 'right') => [
  number(
    `${side}_hand_pitch`,
    'rad',
    '-1 to 1',
    measured(`handTilts.${side}.pitch`),
    `Pitch of the forearm relative to its ${side} hand, up positive; empty: not measured.`,
  ),
  number(
    `${side}_hand_yaw`,
    'rad',
    '-1 to 1',
    measured(`handTilts.${side}.yaw`),
    `Yaw of the forearm relative to its ${side} hand, left positive; empty: not measured.`,
  ),
];

export const trialColumns = [
  ...trialNames,
  number('group', '', ordinals, 'trial: body.group', 'Number of the group; tasks played alone: of the participant.'),
  text(
    'ended',
    trialEnds.join(', '),
    outcome('ended'),
    'Why it ended; absence: given up, because a participant of the group was away; stopped: early.',
  ),
  number('score', 'points', positive, outcome('score'), 'Points; for a group, those of the group.'),
  number('maximum', 'points', '1 and more', outcome('maximum'), 'Highest possible score.'),
  number('percent', '%', positive, 'computed: 100 score / maximum', 'Share of the highest possible score.'),
  number('shots', '', counts, outcome('shots'), 'Shots or throws of this participant.'),
  number('hits', '', counts, outcome('hits'), 'Number of them that scored.'),
  number('seconds', 's', positive, outcome('seconds'), 'From the start signal to the end, pauses left out.'),
  number('frames', '', counts, outcome('frames.count'), 'Frames drawn.'),
  number('missed_frames', '', counts, outcome('frames.missed'), 'Frames that were shown late.'),
  text('device', 'any text', outcome('device.name'), 'Name of the headset or browser.'),
  number(
    'refresh_rate',
    'Hz',
    '1 to 1000',
    outcome('device.refreshRateHz'),
    'Refresh rate of the device; empty: unknown.',
  ),
  text(
    'input',
    'controllers, hands, mixed, emulated, simulated',
    outcome('device.input'),
    'Input of the hands; emulated and simulated: no headset.',
  ),
  number('eye_height', 'm', '0.3 to 2.5', measured('eyeHeight'), 'Height of the eyes above the floor.'),
  number('arm_span', 'm', '0.3 to 2.5', measured('armSpan'), 'From wrist to wrist, arms sideways.'),
  number('forearm', 'm', '0.1 to 0.6', measured('forearm'), 'From elbow to wrist; empty: unknown.'),
  number(
    'gaze_pitch',
    'rad',
    '-0.5 to 0.5',
    measured('gazePitch'),
    'Pitch of the headset when the participant looks ahead, up positive; empty: not measured.',
  ),
  ...tiltColumns('left'),
  ...tiltColumns('right'),
  ...lossColumns('head'),
  ...lossColumns('leftHand'),
  ...lossColumns('rightHand'),
  text(
    'absences',
    'participants: seconds at second, divided by semicolons',
    outcome('absences'),
    'Times for which the match of the group stood because participants were away, the same for all of them; empty: none.',
  ),
  number('absent_seconds', 's', positive, 'computed: sum of outcome.absences[].seconds', 'For how long it stood.'),
  number(
    'from',
    's',
    positive,
    outcome('from'),
    'Second of the match at which the record of this participant begins, after a reload; empty: at its start.',
  ),
  text('assists', 'names, divided by semicolons', outcome('assists'), 'Aids that were on; empty: none.'),
  number('motion_frames', '', counts, outcome('motionFrames'), 'Number of recorded tracking frames.'),
  number(
    'started',
    's',
    moment,
    outcome('clock.epoch'),
    'Second 0 of the trial, by the clock of the device; empty: not known.',
  ),
  number(
    'recording_start',
    's',
    positive,
    outcome('clock.start'),
    'Second 0 on the clock of the recorded frames, which runs on in pauses (pauses.csv); empty: not known.',
  ),
  ...times,
  excluded,
];

const stage = (path: string) => outcome(`frames.stages.*.${path}`);

export const frameTimeColumns = [
  ...trialNames,
  text('stage', 'small letters, hyphens', outcome('frames.stages'), 'Stage of the frame; "frame" is all of its work.'),
  number('count', '', counts, stage('count'), 'Frames measured.'),
  number('min', 'ms', positive, stage('minMs'), 'Shortest.'),
  number('max', 'ms', positive, stage('maxMs'), 'Longest.'),
  number('mean', 'ms', positive, stage('meanMs'), 'Mean.'),
  number('p50', 'ms', positive, stage('p50Ms'), 'Median.'),
  number('p95', 'ms', positive, stage('p95Ms'), '95th percentile.'),
  excluded,
];

export const hitColumns = [
  ...trialNames,
  number(
    'time',
    's',
    positive,
    outcome('events[].time'),
    "Second of the game's clock, which also pauses while the head is lost.",
  ),
  number(
    'onset',
    's',
    positive,
    outcome('events[].onset'),
    'Second of the trial at the frame that showed it; with recording_start and the pauses before it, its place among recorded frames. Empty: not known.',
  ),
  text('type', 'hit, miss, catch', outcome('events[].type'), 'Event; catch: another participant of the group scored.'),
  number('points', 'points', positive, outcome('events[].points'), 'What it scored.'),
  excluded,
];

export const pauseColumns = [
  ...trialNames,
  number('time', 's', positive, outcome('clock.pauses[].time'), 'Second of the trial at which it was paused.'),
  number('seconds', 's', positive, outcome('clock.pauses[].seconds'), 'For how long.'),
  excluded,
];

export const eventColumns = [
  ...who,
  text('event', eventTypes.join(', '), 'event: body.type', 'What happened.'),
  text('task', ids, 'event: body.place.task or body.task', 'Task of the event; empty: none.'),
  number('block', '', ordinals, 'event: body.place.block or body.block', 'Where it concerns one.'),
  number('run', '', ordinals, 'event: body.place.run or body.run', 'Where it concerns one.'),
  text(
    'text',
    'any text',
    'event: body.text, body.reason, or by, measure and value, or participants',
    'Remark or reason, as typed; what was found; who paused or was away.',
  ),
  number('second', 's', positive, 'event: body.time', 'absence: second of the match at which it stood; else empty.'),
  number('seconds', 's', positive, 'event: body.seconds', 'absence: for how long it stood; else empty.'),
  ...times,
];
