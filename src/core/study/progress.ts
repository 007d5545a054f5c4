import * as v from 'valibot';
import type { Calibration } from '../body/calibration';
import type { Schedule, StudyStep } from './plan';
import {
  type Answers,
  checkedAnswers,
  checkedConsent,
  checkedDemographics,
  checkedDraft,
  questionnaires,
} from './questionnaires';
import { type Place, recordVersion, type StudyEvent, type StudyRecord } from './study-record';
import { checkedOutcome, type TrialOutcome } from './trial-log';
import { checked, identifier, integerBetween, numberBetween, participantId, text, ValidationError } from './validation';

export const progressVersion = 1;

const moment = numberBetween(0, 1e11);
/** Nobody sits at a step for longer than this [s]: the page was left open. */
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
  /** Since when the clock runs [s since 1970]; null: it stands. */
  since: v.nullable(moment),
  /** Seconds that it ran before. */
  elapsed: numberBetween(0, longestStep),
  /** The answers given so far in the questionnaire of this step. */
  draft: v.record(v.string(), v.number()),
  /** Whether tracked frames may be kept; null: consent has not been given, so nothing may be recorded. */
  motion: v.nullable(v.boolean()),
  /** "task/block" to its run, where that is not the first. */
  runs: v.record(v.string(), integerBetween(1, 1000)),
  /** Attempts at the present step, from 1. */
  attempt: integerBetween(1, 1000),
  /** Events recorded so far: their ids count on after a reload. */
  events: integerBetween(0, 1_000_000),
});

/** Where a participant is in the schedule: plain JSON, so that it survives reloads and crashes. */
export type Progress = v.InferOutput<typeof progressSchema>;

/** What participant, experimenter, game or clock report. */
export type ProgressEvent =
  | { readonly type: 'consent'; readonly motion: boolean; readonly version: string }
  | { readonly type: 'demographics'; readonly demographics: unknown }
  | { readonly type: 'calibrated'; readonly calibration: Calibration }
  /** Starts the tutorial or trial that waits. */
  | { readonly type: 'start' }
  | { readonly type: 'trial-finished'; readonly outcome: TrialOutcome }
  | { readonly type: 'answer'; readonly question: string; readonly value: number }
  /** Hands the questionnaire in. */
  | { readonly type: 'submit' }
  /** Time has passed. */
  | { readonly type: 'tick' }
  | { readonly type: 'pause' }
  | { readonly type: 'resume' }
  /** The present block counts for nothing; repeat: it starts again, otherwise the next one follows. */
  | { readonly type: 'void-block'; readonly reason: string; readonly repeat: boolean }
  | { readonly type: 'remark'; readonly text: string }
  /** The page was loaded again: a trial that ran is lost and is tried again; everything else goes on. */
  | { readonly type: 'reload' };

/** What follows from an event. */
export interface Advance {
  readonly progress: Progress;
  /** To be stored and sent, in this order. */
  readonly records: readonly StudyRecord[];
  /** Why nothing changed, for a person to read; null: the event was taken. */
  readonly refusal: string | null;
}

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

/** A session from its serialised state; throws a ValidationError that names the field, also where it is of somebody else. */
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
  if (step.kind === 'questionnaire') checkedDraft(questionnaires[step.questionnaire], progress.draft);
  return progress;
}

/** Seconds on the clock of this step, pauses left out; a clock that was set back counts as standing. */
export const elapsedSeconds = (progress: Progress, now: number): number =>
  Math.min(longestStep, progress.elapsed + (progress.since === null ? 0 : Math.max(0, now - progress.since)));

/** Seconds left of this step, at least 0; null: it has no time limit. */
export function remainingSeconds(schedule: Schedule, progress: Progress, now: number): number | null {
  const step = currentStep(schedule, progress);
  return 'seconds' in step ? Math.max(0, step.seconds - elapsedSeconds(progress, now)) : null;
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

/** Rests and questionnaires run from their first moment; games and calibration wait to be started. */
const startsAtOnce = (step: StudyStep) => step.kind === 'rest' || step.kind === 'questionnaire';

function enter(progress: Progress, step: StudyStep, now: number): Progress {
  const running = startsAtOnce(step);
  const since = running && !progress.paused ? now : null;
  return { ...progress, step: step.id, running, since, elapsed: 0, draft: {}, attempt: 1 };
}

const refused = (progress: Progress, refusal: string): Advance => ({ progress, records: [], refusal });

/** What an event makes of a session at `now` [s since 1970]. Events out of place change nothing and say why. */
export function advance(schedule: Schedule, progress: Progress, event: ProgressEvent, now: number): Advance {
  const step = currentStep(schedule, progress);
  const place = placeOf(schedule, progress);
  const base = {
    version: recordVersion,
    study: schedule.study,
    participant: schedule.participant,
    simulated: progress.simulated,
    at: now,
  } as const;
  const suffix = place ? `@${place.run}.${place.attempt}` : '';
  const stepRecordId = (kind: string) => `${step.id}${suffix}:${kind}`;

  const withEvent = (next: Progress, body: StudyEvent): Advance => {
    // Before consent nothing is recorded, not even that somebody paused.
    if (next.motion === null) return { progress: next, records: [], refusal: null };
    const counted = { ...next, events: next.events + 1 };
    return {
      progress: counted,
      records: [{ ...base, kind: 'event', id: `event-${counted.events}`, body }],
      refusal: null,
    };
  };
  const moveOn = (from: Progress, records: readonly StudyRecord[]): Advance => {
    const following = schedule.steps[schedule.steps.indexOf(step) + 1] as StudyStep;
    const entered = enter(from, following, now);
    if (following.kind !== 'end') return { progress: entered, records, refusal: null };
    const finished = withEvent(entered, { type: 'finished' });
    return { ...finished, records: [...records, ...finished.records] };
  };
  const outOfPlace = () => refused(progress, `"${event.type}" has no place in the step "${step.id}"`);
  const attempted = (action: () => Advance): Advance => {
    try {
      return action();
    } catch (error) {
      if (!(error instanceof ValidationError)) throw error;
      return refused(progress, error.message);
    }
  };

  if (progress.paused && !['resume', 'remark', 'void-block', 'trial-finished', 'reload', 'tick'].includes(event.type)) {
    return refused(progress, 'the session is paused');
  }
  switch (event.type) {
    case 'consent':
      if (step.kind !== 'consent') return outOfPlace();
      return attempted(() => {
        const given = { version: event.version, given: true, motion: event.motion, at: now };
        const body = checkedConsent(given, schedule.consentVersion);
        return moveOn({ ...progress, motion: event.motion }, [{ ...base, kind: 'consent', id: 'consent', body }]);
      });
    case 'demographics':
      if (step.kind !== 'demographics') return outOfPlace();
      return attempted(() => {
        const body = checkedDemographics(event.demographics);
        return moveOn(progress, [{ ...base, kind: 'demographics', id: 'demographics', body }]);
      });
    case 'calibrated': {
      if (step.kind !== 'calibration' || !place) return outOfPlace();
      const { eyeHeight, armSpan, gazePitch } = event.calibration;
      const body = { place, eyeHeight, armSpan, ...(gazePitch !== undefined && { gazePitch }) };
      return moveOn(progress, [{ ...base, kind: 'calibration', id: stepRecordId('calibration'), body }]);
    }
    case 'start':
      if ((step.kind !== 'trial' && step.kind !== 'tutorial') || progress.running) return outOfPlace();
      return { progress: { ...progress, running: true, since: now, elapsed: 0 }, records: [], refusal: null };
    case 'trial-finished':
      if ((step.kind !== 'trial' && step.kind !== 'tutorial') || !progress.running || !place) return outOfPlace();
      return attempted(() => {
        const body = {
          place,
          condition: step.kind === 'trial' ? step.condition : null,
          estimator: step.estimator,
          repetition: step.kind === 'trial' ? step.repetition : 1,
          group: schedule.groups[step.task]?.number ?? 1,
          outcome: checkedOutcome(event.outcome),
        };
        return moveOn(progress, [{ ...base, kind: 'trial', id: stepRecordId('trial'), body }]);
      });
    case 'answer':
      if (step.kind !== 'questionnaire') return outOfPlace();
      return attempted(() => {
        const draft = checkedDraft(questionnaires[step.questionnaire], {
          ...progress.draft,
          [event.question]: event.value,
        });
        return { progress: { ...progress, draft: { ...draft } }, records: [], refusal: null };
      });
    case 'submit':
      if (step.kind !== 'questionnaire' || !place) return outOfPlace();
      return attempted(() => {
        const answers: Answers = checkedAnswers(questionnaires[step.questionnaire], progress.draft);
        const seconds = elapsedSeconds(progress, now);
        const { estimator } = schedule.steps.find(
          (other) => other.kind === 'trial' && other.task === step.task && other.block === step.block,
        ) as Extract<StudyStep, { kind: 'trial' }>;
        const body = {
          place,
          condition: step.condition,
          estimator,
          questionnaire: step.questionnaire,
          answers: { ...answers },
          seconds,
          overtime: seconds > step.seconds,
        };
        return moveOn(progress, [{ ...base, kind: 'answers', id: stepRecordId('answers'), body }]);
      });
    case 'tick':
      if (step.kind !== 'rest' || progress.paused || elapsedSeconds(progress, now) < step.seconds) {
        return { progress, records: [], refusal: null };
      }
      return moveOn(progress, []);
    case 'pause': {
      if (step.kind === 'end') return outOfPlace();
      const stopped = { ...progress, paused: true, since: null, elapsed: elapsedSeconds(progress, now) };
      return withEvent(stopped, { type: 'pause' });
    }
    case 'resume':
      if (!progress.paused) return outOfPlace();
      return withEvent({ ...progress, paused: false, since: progress.running ? now : null }, { type: 'resume' });
    case 'void-block':
      if (!place) return outOfPlace();
      return attempted(() => {
        const reason = checked(text(500), event.reason);
        const { task, block, run } = place;
        const ofBlock = (other: StudyStep) => 'task' in other && other.task === task && other.block === block;
        const target = event.repeat
          ? (schedule.steps.find(ofBlock) as StudyStep)
          : (schedule.steps[schedule.steps.findLastIndex(ofBlock) + 1] as StudyStep);
        const runs = event.repeat ? { ...progress.runs, [`${task}/${block}`]: run + 1 } : progress.runs;
        const voided = withEvent(enter({ ...progress, runs, paused: false }, target, now), {
          type: 'void-block',
          task,
          block,
          run,
          reason,
          repeat: event.repeat,
        });
        if (target.kind !== 'end') return voided;
        const finished = withEvent(voided.progress, { type: 'finished' });
        return { ...finished, records: [...voided.records, ...finished.records] };
      });
    case 'remark':
      if (progress.motion === null) return refused(progress, 'nothing is recorded before consent');
      return attempted(() => withEvent(progress, { type: 'remark', text: checked(text(2000), event.text) }));
    case 'reload': {
      const lost = (step.kind === 'trial' || step.kind === 'tutorial') && progress.running;
      if (!lost || !place) return withEvent(progress, { type: 'reload' });
      const again = { ...progress, running: false, since: null, elapsed: 0, attempt: progress.attempt + 1 };
      return withEvent(again, { type: 'interrupted', place, step: step.id });
    }
  }
}
