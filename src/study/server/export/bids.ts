import { parseRecording, type Recording, reasonOf } from 'threepoint/core';
import {
  bidsChannelFrames,
  bidsChannels,
  bidsMotion,
  bidsMotionSidecar,
  bidsTable,
  bidsVersion,
} from 'threepoint/internal';
import { type StudyPlan, studyTitle } from '../../model/plan/plan';
import type { DemographicsRecord, StudyRecord, TrialRecord } from '../../model/records/study-record';
import { recordingTime } from '../../model/records/trial-clock';
import { incompleteReason } from '../../model/records/trial-log';
import { voidedBlocks } from '../../model/tables/study-tables';
import type { MotionFile } from '../study-storage';

export interface BidsContent {
  readonly plan: StudyPlan;
  readonly simulated: boolean;
  readonly records: readonly StudyRecord[];
  readonly motion: readonly MotionFile[];
}

export interface BidsDataset {
  /** The text of each file by its path in the data set; none without motion. */
  readonly files: Readonly<Record<string, string>>;
  /** The reason for each recording that is left out. */
  readonly leftOut: readonly string[];
}

/** A trial with a recording. */
interface Run {
  readonly trial: TrialRecord;
  /** The time of its first frame on its clock [s]. */
  readonly first: number;
  readonly label: string;
  /** Counted from 1 for each participant and task, in the order in which they were played. */
  readonly number: number;
}

const trackingSystem = 'tracksys-webxr';

/** Removes characters that names in BIDS may not have. */
const labelOf = (task: string): string => task.replaceAll('-', '');

const described = (description: string, rest: object = {}) => ({ Description: description, ...rest });

const participantColumns = {
  participant_id: described('Code of the participant.'),
  age: described('As stated.', { Units: 'year' }),
  handedness: described('As stated.', { Levels: { left: 'left', right: 'right', ambidextrous: 'both' } }),
  gender: described('As stated: woman, man, non-binary, other, not-said.'),
  vr_experience: described('none, once-or-twice, several-times, monthly, weekly.'),
  vision: described('normal, corrected, impaired.'),
};

const scanColumns = {
  filename: described('Recording.'),
  acq_time: described('Its first frame, UTC, by the clock of the device.'),
  task: described('Id of the task.'),
  condition: described('Id of the condition.'),
  estimator: described('Estimator of the body.'),
  block: described('Place of the condition in the order of this participant, from 1.'),
  block_run: described('From 1; a block that was voided and repeated runs again.'),
  attempt: described('From 1; a trial lost by a crash or reload is tried again.'),
  repetition: described('Trial of the block, from 1.'),
  excluded: described('Why the trial is not counted; n/a: it is.'),
};

const eventColumns = {
  onset: described(
    'Since the first frame of the recording, on its clock, which runs on in pauses (the channel "latency"). Right to a frame.',
    { Units: 's' },
  ),
  duration: described('On the same clock.', { Units: 's' }),
  trial_type: described('What happened.', {
    Levels: {
      trial: 'from the start signal to the end, pauses within',
      pause: 'the trial was paused; frames of this time are not recorded',
      hit: 'an attempt of this participant scored',
      miss: 'one did not',
      catch: 'another participant scored for the group',
    },
  }),
  points: described('What it scored.'),
  trial_time: described('Second of the trial, without pauses.', { Units: 's' }),
  game_time: described("Second of the game's clock, which also pauses while the head is lost.", { Units: 's' }),
};

const table = (columns: object, rows: readonly Readonly<Record<string, unknown>>[]): string =>
  bidsTable(Object.keys(columns), rows);

const json = (value: unknown): string => `${JSON.stringify(value, null, 2)}\n`;

const seconds = (value: number): number => Math.round(value * 1e6) / 1e6;

/** Returns the events of a trial on the clock of its recording, or null if the record has no clock. */
function eventRows({ trial, first }: Run): Readonly<Record<string, unknown>>[] | null {
  const { clock, events, seconds: length } = trial.body.outcome;
  if (!clock) return null;
  const onset = (second: number) => seconds(recordingTime(clock, second) - first);
  const row = (type: string, second: number) => ({
    onset: onset(second),
    duration: 0,
    trial_type: type,
    points: null,
    trial_time: seconds(second),
    game_time: null,
  });
  const rows = [
    { ...row('trial', 0), duration: seconds(onset(length) - onset(0)) },
    ...clock.pauses.map((pause) => ({
      ...row('pause', pause.time),
      onset: seconds(onset(pause.time) - pause.seconds),
      duration: seconds(pause.seconds),
    })),
    ...events.flatMap(({ onset: second, type, points, time }) =>
      second === undefined ? [] : [{ ...row(type, second), points, game_time: seconds(time) }],
    ),
  ];
  return rows.toSorted((a, b) => a.onset - b.onset);
}

const pathOf = ({ trial, label, number }: Run, suffix: string, system = `_${trackingSystem}`): string => {
  const subject = `sub-${trial.participant}`;
  return `${subject}/motion/${subject}_task-${label}${system}_run-${number}_${suffix}`;
};

function runFiles(run: Run, recording: Recording): Record<string, string> {
  const events = eventRows(run);
  return {
    [pathOf(run, 'motion.tsv')]: bidsMotion(recording),
    [pathOf(run, 'motion.json')]: json({ TaskName: run.trial.body.place.task, ...bidsMotionSidecar(recording) }),
    [pathOf(run, 'channels.tsv')]: bidsChannels(),
    ...(events && { [pathOf(run, 'events.tsv', '')]: table(eventColumns, events) }),
  };
}

function scanRow(run: Run, excluded: string): Readonly<Record<string, unknown>> {
  const { place, condition, estimator, repetition, outcome } = run.trial.body;
  const { clock } = outcome;
  const acquired = clock && new Date(1000 * (clock.epoch + run.first - clock.start));
  return {
    filename: pathOf(run, 'motion.tsv').replace(/^[^/]*\//, ''),
    acq_time: acquired?.toISOString() ?? null,
    task: place.task,
    condition,
    estimator,
    block: place.block,
    block_run: place.run,
    attempt: place.attempt,
    repetition,
    excluded,
  };
}

function participantRow(participant: string, stated: DemographicsRecord['body'] | undefined) {
  return {
    participant_id: `sub-${participant}`,
    age: stated?.age ?? null,
    handedness: stated?.handedness === 'both' ? 'ambidextrous' : (stated?.handedness ?? null),
    gender: stated?.gender ?? null,
    vr_experience: stated?.vrExperience ?? null,
    vision: stated?.vision ?? null,
  };
}

/** Writes the files of each recording one after the other, because together they would not fit into memory. */
function writeRuns({ records, motion }: BidsContent) {
  const trials = new Map(
    records.flatMap((record) =>
      record.kind === 'trial' ? [[`${record.participant} ${record.id}`, record] as const] : [],
    ),
  );
  const files: Record<string, string> = {};
  const runs: Run[] = [];
  const leftOut: string[] = [];
  const recorded = motion.map((file) => ({
    ...file,
    trial: trials.get(`${file.participant} ${file.trial}`),
    id: file.trial,
  }));
  for (const { participant, id, trial, text } of recorded.toSorted((a, b) => (a.trial?.at ?? 0) - (b.trial?.at ?? 0))) {
    try {
      if (!trial) throw new Error('There is no record of this trial.');
      const recording = parseRecording(text);
      const label = labelOf(trial.body.place.task);
      const before = runs.filter((run) => run.trial.participant === participant && run.label === label);
      const run = { trial, first: recording.frames[0]!.time, label, number: before.length + 1 };
      Object.assign(files, runFiles(run, recording));
      runs.push(run);
    } catch (error) {
      leftOut.push(`${participant} ${id}: ${reasonOf(error)}`);
    }
  }
  return { files, runs, leftOut };
}

const readme = ({ plan, simulated }: BidsContent): string =>
  [
    ...(simulated ? ['SIMULATED: a program made this. It says nothing about people.', ''] : []),
    `Motion of head and wrists in the study "${studyTitle(plan)}" (${plan.id}), as BIDS ${bidsVersion} motion data.`,
    '',
    'Only participants who consented to motion recording. A run is a trial; *_scans.tsv has its condition and whether it is counted.',
    'Frame: the floor where the headset has it, +X right, +Y up, +Z backward, right-handed, in metres (channels.json).',
    'Clock: "latency" and the onsets of events start at the first frame and include pauses. The second of the trial, without',
    'pauses, is the column trial_time. acq_time is the first frame by the clock of the device.',
    'An untracked hand is n/a in all its channels.',
    '',
  ].join('\n');

/** Returns the motion of a study as a BIDS data set; unreadable recordings are left out with the reason. */
export function bidsDataset(content: BidsContent): BidsDataset {
  const { plan, simulated, records } = content;
  const { files: written, runs, leftOut } = writeRuns(content);
  if (runs.length === 0) return { files: {}, leftOut };
  const participants = [...new Set(runs.map(({ trial }) => trial.participant))].toSorted();
  const stated = new Map(
    records.flatMap((record) => (record.kind === 'demographics' ? [[record.participant, record.body] as const] : [])),
  );
  const excluded = voidedBlocks(records);
  const files: Record<string, string> = {
    'dataset_description.json': json({
      Name: simulated ? `SIMULATED ${studyTitle(plan)}` : studyTitle(plan),
      BIDSVersion: bidsVersion,
      DatasetType: 'raw',
      GeneratedBy: [{ Name: 'threepoint' }],
    }),
    README: readme(content),
    'participants.tsv': table(
      participantColumns,
      participants.map((id) => participantRow(id, stated.get(id))),
    ),
    'participants.json': json(participantColumns),
    ...written,
  };
  for (const label of new Set(runs.map((run) => run.label))) {
    files[`task-${label}_events.json`] = json(eventColumns);
    files[`task-${label}_${trackingSystem}_channels.json`] = json(bidsChannelFrames);
  }
  for (const participant of participants) {
    const own = runs.filter(({ trial }) => trial.participant === participant);
    const scans = `sub-${participant}/sub-${participant}_scans`;
    files[`${scans}.tsv`] = table(
      scanColumns,
      own.map((run) => {
        const { place, outcome } = run.trial.body;
        return scanRow(run, excluded(participant, place) || incompleteReason(outcome));
      }),
    );
    files[`${scans}.json`] = json(scanColumns);
  }
  return { files, leftOut };
}
