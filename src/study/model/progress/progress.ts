import {
  checked,
  identifier,
  integerBetween,
  numberBetween,
  participantId,
  text,
  ValidationError,
} from 'threepoint/core/validation/validation';
import * as v from 'valibot';
import { languageTag } from '../phrases/words';
import type { Schedule, StudyStep } from '../plan/schedule';
import { checkedDraft } from '../questionnaires/questionnaires';
import type { Place } from '../records/study-record';

export const progressVersion = 1;

const moment = numberBetween(0, 1e11);
/** A step that lasts longer than this [s] is a page that was left open. */
const longestStep = 1e7;

const progressSchema = v.object({
  version: v.literal(progressVersion, `expected ${progressVersion}, the version that this program reads`),
  study: identifier,
  participant: participantId,
  simulated: v.boolean(),
  /** Id of the step that the participant is at. */
  step: text(120),
  /** Whether the step's clock has been started. */
  running: v.boolean(),
  paused: v.boolean(),
  /** Since when the clock runs, by the clock of this device [s since 1970]; null: it stands, or this is a report. */
  since: v.nullable(moment),
  /** Seconds that it ran before. */
  elapsed: numberBetween(0, longestStep),
  /** The answers given so far in the questionnaire of this step. */
  draft: v.record(v.string(), v.union([v.number(), v.string()])),
  /** Whether tracked frames may be kept; null: consent has not been given, so nothing may be recorded. */
  motion: v.nullable(v.boolean()),
  /** In which the participant reads; absent: the study has only one. */
  language: v.exactOptional(languageTag),
  /** "task/block" to its run, where that is not the first. */
  runs: v.record(v.string(), integerBetween(1, 1000)),
  /** What was answered says that the participant may be unwell, and whether to stop is not decided yet; absent: no such question. */
  unwell: v.exactOptional(v.boolean()),
  /** The participant stopped, or was stopped, before the end; absent: not. */
  stopped: v.exactOptional(v.boolean()),
  /** Number of the newest of the experimenter's commands that was followed; absent: none, or told by a program that did not say. */
  commandsSeen: v.exactOptional(integerBetween(0, Number.MAX_SAFE_INTEGER)),
  /** How often this session has changed: of two states of it, which is the later; absent: never, or told by a program that did not count. */
  changes: v.exactOptional(integerBetween(0, Number.MAX_SAFE_INTEGER)),
  /** Attempts at the present step, from 1. */
  attempt: integerBetween(1, 1000),
  /** Events recorded so far: their ids count on after a reload. */
  events: integerBetween(0, 1_000_000),
});

/** Where a participant is in the schedule: plain JSON, so that it survives reloads and crashes. */
export type Progress = v.InferOutput<typeof progressSchema>;

/** The beginning of a session. */
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
    attempt: 1,
    events: 0,
  };
}

/** The step that the participant is at; throws where the schedule has no such step. */
export function currentStep(schedule: Schedule, progress: Progress): StudyStep {
  const step = schedule.steps.find(({ id }) => id === progress.step);
  if (!step)
    throw new ValidationError('step', `the schedule of ${schedule.participant} has no step "${progress.step}"`);
  return step;
}

/** A session from its serialised state; throws a ValidationError that names the field, also where it is another participant's. */
export function resumed(schedule: Schedule, json: string): Progress {
  let value: unknown;
  try {
    value = JSON.parse(json);
  } catch (error) {
    if (!(error instanceof SyntaxError)) throw error;
    throw new ValidationError('', `the stored session is no JSON: ${error.message}`);
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

/** Seconds on the clock of this step, pauses left out; a clock that was set back counts as standing. */
export const elapsedSeconds = (progress: Progress, now: number): number =>
  Math.min(longestStep, progress.elapsed + (progress.since === null ? 0 : Math.max(0, now - progress.since)));

/**
 * What the server is told at `now` [s since 1970]: seconds that ran until now, and no moment, for clocks of devices and servers differ by
 * minutes.
 */
export const reported = (progress: Progress, now: number): Progress =>
  progress.since === null ? progress : { ...progress, elapsed: elapsedSeconds(progress, now), since: null };

const runs = ({ running, paused }: Progress): boolean => running && !paused;

/** A report so many seconds later: the clock ran on. */
export const sinceReport = (report: Progress, seconds: number): Progress =>
  runs(report) && report.since === null
    ? { ...report, elapsed: Math.min(longestStep, report.elapsed + Math.max(0, seconds)) }
    : report;

/** The clock runs on by that of this device, which says `now` [s since 1970]: after a report, or where it was set back behind `since`. */
export const runningOn = (progress: Progress, now: number): Progress =>
  runs(progress) && (progress.since === null || progress.since > now) ? { ...progress, since: now } : progress;

/**
 * Whether one state of a session came after another one. Devices and reports can be late: a device whose storage was full resumes an older
 * state, and a request may arrive after its successor. Blocks that run again count first, then the step, its attempt, and what changed within it.
 */
export function isLater(schedule: Schedule, state: Progress, than: Progress): boolean {
  const order = ({ runs, step, attempt, changes = 0 }: Progress) => [
    Object.values(runs).reduce((sum, run) => sum + run, 0),
    schedule.steps.findIndex(({ id }) => id === step),
    attempt,
    changes,
  ];
  const [one, other] = [order(state), order(than)];
  const differing = one.findIndex((value, index) => value !== other[index]);
  return differing >= 0 && (one[differing] as number) > (other[differing] as number);
}

/** Seconds left of this step, at least 0; null: it has no time limit. */
export function remainingSeconds(schedule: Schedule, progress: Progress, now: number): number | null {
  const step = currentStep(schedule, progress);
  return 'seconds' in step ? Math.max(0, step.seconds - elapsedSeconds(progress, now)) : null;
}

/** Seconds that are left as minutes and seconds, "7:00"; a second that has begun counts whole. */
export function clockText(seconds: number): string {
  const whole = Math.ceil(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}`;
}

/** Where in the study the participant is; null outside of the tasks. */
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
