import {
  checked,
  identifier,
  integerBetween,
  numberBetween,
  participantId,
  text,
  ValidationError,
} from 'threepoint/core';
import * as v from 'valibot';
import { languageTag } from '../phrases/localized-text';
import type { Schedule, StudyStep } from '../plan/schedule';
import { checkedDraft } from '../questionnaires/questionnaires';
import type { Place } from '../records/study-record';

export const progressVersion = 1;

const moment = numberBetween(0, 1e11);
/** A longer step is a page that was left open [s]. */
const longestStep = 1e7;

const progressSchema = v.object({
  version: v.literal(progressVersion, `expected ${progressVersion}, the version that this program reads`),
  study: identifier,
  participant: participantId,
  simulated: v.boolean(),
  step: text(120),
  /** Whether the clock of the step was started. */
  running: v.boolean(),
  paused: v.boolean(),
  /** The start of the clock by the clock of this device [s since 1970]; null: it is stopped, or this is a report. */
  since: v.nullable(moment),
  /** The seconds of earlier runs of the clock. */
  elapsed: numberBetween(0, longestStep),
  /** The answers so far to the questionnaire of this step. */
  draft: v.record(v.string(), v.union([v.number(), v.string()])),
  /** Whether tracking frames may be kept; null: there is no consent yet, so nothing may be recorded. */
  motion: v.nullable(v.boolean()),
  /** The language of the participant; absent: the study has only one. */
  language: v.exactOptional(languageTag),
  /** The run of a block by "task/block", if it is not the first. */
  runs: v.record(v.string(), integerBetween(1, 1000)),
  /** Whether the participant is asked, because of answers, whether to stop. */
  unwell: v.boolean(),
  /** The repeated blocks, "task/block", whose practice was finished before they were voided. */
  practised: v.array(text(120)),
  /** Whether the match of a started trial has not begun or stands, and with it the clock. */
  waiting: v.boolean(),
  /** Whether a void block led to this step, which its sheet states. */
  voided: v.boolean(),
  /** Whether the participant stopped, or was stopped, before the end. */
  stopped: v.boolean(),
  /** The number of the newest command of the experimenter that was followed; 0: none. */
  commandsSeen: integerBetween(0, Number.MAX_SAFE_INTEGER),
  /** The number of changes of this session, by which states are ordered. */
  changes: integerBetween(0, Number.MAX_SAFE_INTEGER),
  /** The attempt at the present step, from 1. */
  attempt: integerBetween(1, 1000),
  /** The number of recorded events, which continue their ids after a reload. */
  events: integerBetween(0, 1_000_000),
});

/** The progress of a participant in the schedule, as plain JSON that survives reloads and crashes. */
export type Progress = v.InferOutput<typeof progressSchema>;

export function begin(schedule: Schedule, simulated = false): Progress {
  return {
    version: progressVersion,
    study: schedule.study,
    participant: schedule.participant,
    simulated,
    step: (schedule.steps[0] as StudyStep).id,
    running: false,
    paused: false,
    since: null,
    elapsed: 0,
    draft: {},
    motion: null,
    runs: {},
    unwell: false,
    practised: [],
    waiting: false,
    voided: false,
    stopped: false,
    commandsSeen: 0,
    changes: 0,
    attempt: 1,
    events: 0,
  };
}

/** Returns the present step; throws if the schedule does not have it. */
export function currentStep(schedule: Schedule, progress: Progress): StudyStep {
  const step = schedule.steps.find(({ id }) => id === progress.step);
  if (!step)
    throw new ValidationError('step', `the schedule of ${schedule.participant} has no step "${progress.step}"`);
  return step;
}

/**
 * Returns the progress from its serialised form; throws a ValidationError that names the field, also for that of
 * another participant.
 */
export function resumed(schedule: Schedule, json: string): Progress {
  let value: unknown;
  try {
    value = JSON.parse(json);
  } catch (error) {
    if (!(error instanceof SyntaxError)) throw error;
    throw new ValidationError('', `the stored session is not JSON: ${error.message}`);
  }
  const progress = checked(progressSchema, value);
  for (const field of ['study', 'participant'] as const) {
    if (progress[field] !== schedule[field]) {
      throw new ValidationError(field, `the stored session is of ${progress[field]}, not of ${schedule[field]}`);
    }
  }
  const step = currentStep(schedule, progress);
  if (step.kind === 'questionnaire') checkedDraft(step.questionnaire, progress.draft);
  return progress;
}

/** Returns the seconds on the clock of this step without pauses; a clock that was set back counts as stopped. */
export const elapsedSeconds = (progress: Progress, now: number): number =>
  Math.min(longestStep, progress.elapsed + (progress.since === null ? 0 : Math.max(0, now - progress.since)));

/**
 * Returns the progress as it is reported to the server at `now` [s since 1970]: with elapsed seconds instead of times,
 * because the clocks of devices and servers differ by minutes.
 */
export const reported = (progress: Progress, now: number): Progress =>
  progress.since === null ? progress : { ...progress, elapsed: elapsedSeconds(progress, now), since: null };

const runs = ({ running, paused, waiting }: Progress): boolean => running && !paused && !waiting;

/** Returns a report a number of seconds later, with its clock advanced. */
export const sinceReport = (report: Progress, seconds: number): Progress =>
  runs(report) ? { ...report, elapsed: Math.min(longestStep, report.elapsed + Math.max(0, seconds)) } : report;

/**
 * Returns the progress with its clock running by that of this device at `now` [s since 1970], after a report or if the
 * clock was set back behind `since`.
 */
export const runningOn = (progress: Progress, now: number): Progress =>
  runs(progress) && (progress.since === null || progress.since > now) ? { ...progress, since: now } : progress;

/**
 * Returns whether one state of a session is later than another. Devices and reports can be late: a device with full
 * storage resumes an older state, and a request may arrive after its successor. Repeated blocks are compared first,
 * then the step, its attempt, and the changes within it.
 */
export function isLater(schedule: Schedule, state: Progress, than: Progress): boolean {
  const order = ({ runs, step, attempt, changes }: Progress) => [
    Object.values(runs).reduce((sum, run) => sum + run, 0),
    schedule.steps.findIndex(({ id }) => id === step),
    attempt,
    changes,
  ];
  const [one, other] = [order(state), order(than)];
  const differing = one.findIndex((value, index) => value !== other[index]);
  return differing >= 0 && (one[differing] as number) > (other[differing] as number);
}

/** Returns the seconds left of this step, at least 0, or null if it has no limit. */
export function remainingSeconds(schedule: Schedule, progress: Progress, now: number): number | null {
  const step = currentStep(schedule, progress);
  return 'seconds' in step ? Math.max(0, step.seconds - elapsedSeconds(progress, now)) : null;
}

/** Formats seconds as minutes and seconds, "7:00", rounded up. */
export function clockText(seconds: number): string {
  const whole = Math.ceil(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}`;
}

/** Returns the place in the study, or null outside of the tasks. */
export function placeOf(schedule: Schedule, progress: Progress): Place | null {
  const step = currentStep(schedule, progress);
  if (!('task' in step)) return null;
  return {
    task: step.task,
    block: step.block,
    run: progress.runs[`${step.task}/${step.block}`] ?? 1,
    attempt: progress.attempt,
  };
}
