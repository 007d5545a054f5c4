import type { Calibration } from 'threepoint/core/body/calibration';
import { checked, text, ValidationError } from 'threepoint/core/validation/validation';
import { isPlayed, type PlayedStep, type Schedule, type StudyStep, trialOf } from '../plan/schedule';
import type { Answer } from '../questionnaires/question-kind';
import { checkedAnswers, checkedDraft } from '../questionnaires/questionnaires';
import { reachedRule } from '../questionnaires/stopping-rule';
import { checkedConsent } from '../records/consent';
import { checkedDemographics } from '../records/demographics';
import { type Place, recordVersion, type StudyEvent, type StudyRecord } from '../records/study-record';
import { checkedOutcome, type TrialOutcome } from '../records/trial-log';
import { currentStep, elapsedSeconds, type Progress, placeOf, runningOn } from './progress';
import type { MeantBlock } from './study-api';

/** An event from participant, experimenter, game or clock. */
export type ProgressEvent =
  /** `language` is that of the text that was read; absent: the study has only one. */
  | { readonly type: 'consent'; readonly motion: boolean; readonly version: string; readonly language?: string }
  | { readonly type: 'demographics'; readonly demographics: unknown }
  | { readonly type: 'calibrated'; readonly calibration: Calibration }
  /** Starts the waiting tutorial or trial. */
  | { readonly type: 'start' }
  | { readonly type: 'trial-finished'; readonly outcome: TrialOutcome }
  /** null removes the answer. */
  | { readonly type: 'answer'; readonly question: string; readonly value: Answer | null }
  /** Hands the questionnaire in. */
  | { readonly type: 'submit' }
  /** Lets time pass. */
  | { readonly type: 'tick' }
  | { readonly type: 'pause' }
  /** Ends the session at any step. */
  | { readonly type: 'stop'; readonly by: 'participant' | 'experimenter'; readonly reason?: string }
  /** Continues after the participant was asked, because of answers, whether to stop. */
  | { readonly type: 'go-on' }
  | { readonly type: 'resume' }
  /** Voids the present block if it is the intended one; repeat: it starts again, otherwise the next one follows. */
  | { readonly type: 'void-block'; readonly reason: string; readonly repeat: boolean; readonly of?: MeantBlock }
  | { readonly type: 'remark'; readonly text: string }
  /**
   * Reports that the page was reloaded, here or on another device. A running trial is void and repeated; everything
   * else continues.
   */
  | { readonly type: 'reload' };

/** The result of an event. */
export interface Advance {
  readonly progress: Progress;
  /** The records to store and send, in this order. */
  readonly records: readonly StudyRecord[];
  /** Why nothing changed, in a sentence; null: the event was accepted. */
  readonly refusal: string | null;
}

type EventOf<Type extends ProgressEvent['type']> = Extract<ProgressEvent, { type: Type }>;

/** The events that are accepted during a pause. */
const takenInPause: readonly ProgressEvent['type'][] = [
  'resume',
  'remark',
  'void-block',
  'trial-finished',
  'reload',
  'tick',
  'stop',
  'go-on',
];

/** The reasons for refusals that participants can cause by pressing at the wrong moment. */
export const refusals = {
  paused: 'the session is paused',
  asked: 'the participant is asked whether to stop',
} as const;

/** The events that wait until a participant who may be unwell has decided. */
const notWhileAsked: readonly ProgressEvent['type'][] = ['start', 'calibrated', 'answer', 'submit'];

/**
 * Applies an event to a session at `now` [s since 1970]. An event that does not fit the step changes nothing and is
 * refused with a reason.
 */
export function advance(schedule: Schedule, progress: Progress, event: ProgressEvent, now: number): Advance {
  const at = new Moment(schedule, progress, now);
  if (progress.paused && !takenInPause.includes(event.type)) return at.refused(refusals.paused);
  if (progress.unwell && notWhileAsked.includes(event.type)) {
    return at.refused(refusals.asked);
  }
  try {
    const next =
      (handlers[event.type] as Handler)(at, event) ??
      at.refused(`"${event.type}" does not fit the step "${at.step.id}"`);
    if (next.progress === progress) return next;
    return { ...next, progress: { ...next.progress, changes: (progress.changes ?? 0) + 1 } };
  } catch (error) {
    if (!(error instanceof ValidationError)) throw error;
    return at.refused(error.message);
  }
}

/** A session at the time of an event, and its possible continuations. */
class Moment {
  readonly schedule: Schedule;
  readonly progress: Progress;
  /** The time in seconds since 1970. */
  readonly now: number;
  readonly step: StudyStep;
  /** null outside of the tasks. */
  readonly place: Place | null;

  constructor(schedule: Schedule, progress: Progress, now: number) {
    this.schedule = schedule;
    this.progress = progress;
    this.now = now;
    this.step = currentStep(schedule, progress);
    this.place = placeOf(schedule, progress);
  }

  /** The fields that every record of this moment has. */
  get envelope() {
    const { study, participant } = this.schedule;
    return { version: recordVersion, study, participant, simulated: this.progress.simulated, at: this.now } as const;
  }

  /** Returns the id of a record of this attempt at the step, so that sending it twice stores it once. */
  recordId(kind: string): string {
    const suffix = this.place ? `@${this.place.run}.${this.place.attempt}` : '';
    return `${this.step.id}${suffix}:${kind}`;
  }

  refused(refusal: string): Advance {
    return { progress: this.progress, records: [], refusal };
  }

  taken(progress: Progress, records: readonly StudyRecord[] = []): Advance {
    return { progress, records, refusal: null };
  }

  /** Returns the session with a record of what happened; nothing is recorded before consent, not even a pause. */
  withEvent(next: Progress, body: StudyEvent): Advance {
    if (next.motion === null) return this.taken(next);
    const counted = { ...next, events: next.events + 1 };
    return this.taken(counted, [{ ...this.envelope, kind: 'event', id: `event-${counted.events}`, body }]);
  }

  /** Returns the session at the next step. */
  moveOn(from: Progress, records: readonly StudyRecord[] = []): Advance {
    return this.enter(from, this.schedule.steps[this.schedule.steps.indexOf(this.step) + 1] as StudyStep, records);
  }

  enter(from: Progress, step: StudyStep, records: readonly StudyRecord[]): Advance {
    const entered = this.entered(from, step);
    if (step.kind !== 'end') return this.taken(entered, records);
    const finished = this.withEvent(entered, { type: 'finished' });
    return this.taken(finished.progress, [...records, ...finished.records]);
  }

  /** The clocks of rests and questionnaires start at once; games and calibration wait for a start. */
  entered(from: Progress, step: StudyStep): Progress {
    const running = step.kind === 'rest' || step.kind === 'questionnaire';
    const since = running && !from.paused ? this.now : null;
    return { ...from, step: step.id, running, since, elapsed: 0, draft: {}, attempt: 1 };
  }
}

function consent(at: Moment, { version, motion, language }: EventOf<'consent'>): Advance | null {
  if (at.step.kind !== 'consent') return null;
  const chosen = language === undefined ? {} : { language };
  const body = checkedConsent({ version, given: true, motion, at: at.now, ...chosen }, at.schedule.consentVersion);
  return at.moveOn({ ...at.progress, motion, ...chosen }, [{ ...at.envelope, kind: 'consent', id: 'consent', body }]);
}

function demographics(at: Moment, event: EventOf<'demographics'>): Advance | null {
  if (at.step.kind !== 'demographics') return null;
  const body = checkedDemographics(event.demographics);
  return at.moveOn(at.progress, [{ ...at.envelope, kind: 'demographics', id: 'demographics', body }]);
}

function calibrated(at: Moment, { calibration }: EventOf<'calibrated'>): Advance | null {
  const { place } = at;
  if (at.step.kind !== 'calibration' || !place) return null;
  const { eyeHeight, armSpan, gazePitch, handTilts } = calibration;
  const body = {
    place,
    eyeHeight,
    armSpan,
    ...(gazePitch !== undefined && { gazePitch }),
    ...(handTilts !== undefined && { handTilts }),
  };
  return at.moveOn(at.progress, [{ ...at.envelope, kind: 'calibration', id: at.recordId('calibration'), body }]);
}

function start(at: Moment): Advance | null {
  if (!isPlayed(at.step) || at.progress.running) return null;
  return at.taken({ ...at.progress, running: true, since: at.now, elapsed: 0 });
}

function trialFinished(at: Moment, { outcome }: EventOf<'trial-finished'>): Advance | null {
  const { step, place, progress } = at;
  if (!isPlayed(step) || !progress.running || !place) return null;
  const body = {
    place,
    condition: step.kind === 'trial' ? step.condition : null,
    estimator: step.embodiment.estimator,
    repetition: step.kind === 'trial' ? step.repetition : 1,
    group: at.schedule.groups[step.task]?.number ?? 1,
    outcome: checkedOutcome(outcome),
  };
  return at.moveOn(progress, [{ ...at.envelope, kind: 'trial', id: at.recordId('trial'), body }]);
}

function answer(at: Moment, { question, value }: EventOf<'answer'>): Advance | null {
  const { step, progress } = at;
  if (step.kind !== 'questionnaire') return null;
  const { [question]: _, ...others } = progress.draft;
  const draft = checkedDraft(step.questionnaire, value === null ? others : { ...progress.draft, [question]: value });
  return at.taken({ ...progress, draft: { ...draft } });
}

function submit(at: Moment): Advance | null {
  const { step, place, progress } = at;
  if (step.kind !== 'questionnaire' || !place) return null;
  const answers = checkedAnswers(step.questionnaire, progress.draft);
  const seconds = elapsedSeconds(progress, at.now);
  const { embodiment } = trialOf(at.schedule, step) as PlayedStep;
  const body = {
    place,
    condition: step.condition,
    estimator: embodiment.estimator,
    questionnaire: step.questionnaire.id,
    ...(progress.language !== undefined && { language: progress.language }),
    answers: { ...answers },
    seconds,
    overtime: seconds > step.seconds,
  };
  const handedIn = [{ ...at.envelope, kind: 'answers', id: at.recordId('answers'), body } as const];
  const unwell = reachedRule(at.schedule.askToStop, step.questionnaire, body.answers);
  if (!unwell) return at.moveOn(progress, handedIn);
  const { questionnaire, measure, value } = unwell;
  const recorded = at.withEvent(
    { ...progress, unwell: true },
    { type: 'unwell', place, questionnaire, measure, value },
  );
  return at.moveOn(recorded.progress, [...handedIn, ...recorded.records]);
}

function tick(at: Moment): Advance {
  const { step, progress } = at;
  const over = step.kind === 'rest' && !progress.paused && elapsedSeconds(progress, at.now) >= step.seconds;
  return over ? at.moveOn(progress) : at.taken(runningOn(progress, at.now));
}

function pause(at: Moment): Advance | null {
  const { step, progress } = at;
  if (step.kind === 'end') return null;
  const stopped = { ...progress, paused: true, since: null, elapsed: elapsedSeconds(progress, at.now) };
  return at.withEvent(stopped, { type: 'pause' });
}

function stop(at: Moment, { by, reason }: EventOf<'stop'>): Advance | null {
  const { step, place, progress, schedule } = at;
  if (step.kind === 'end') return null;
  if (progress.motion === null) return at.refused('nothing is recorded before consent');
  const { unwell: _, ...decided } = progress;
  const stated = reason === undefined ? {} : { reason: checked(text(500), reason) };
  const recorded = at.withEvent(
    { ...decided, stopped: true, paused: false },
    { type: 'stop', by, ...stated, place, step: step.id },
  );
  return at.taken(at.entered(recorded.progress, schedule.steps.at(-1) as StudyStep), recorded.records);
}

/**
 * Questions after the question whether to stop were not shown yet, so their clock starts now. A rest has run in the
 * meantime.
 */
function goOn(at: Moment): Advance | null {
  const { unwell, ...decided } = at.progress;
  if (!unwell) return null;
  const begins = at.step.kind === 'questionnaire' ? at.entered(decided, at.step) : decided;
  return at.withEvent(begins, { type: 'go-on' });
}

function resume(at: Moment): Advance | null {
  const { progress } = at;
  if (!progress.paused) return null;
  return at.withEvent({ ...progress, paused: false, since: progress.running ? at.now : null }, { type: 'resume' });
}

function voidBlock(at: Moment, event: EventOf<'void-block'>): Advance | null {
  if (!at.place) return null;
  const { repeat, of } = event;
  const { task, block, run } = at.place;
  if (of && (of.task !== task || of.block !== block)) {
    return at.refused(`block ${of.block} of "${of.task}", which the command is for, is not under way`);
  }
  const { steps } = at.schedule;
  const { runs } = at.progress;
  const reason = checked(text(500), event.reason);
  const ofBlock = (step: StudyStep) => 'task' in step && step.task === task && step.block === block;
  const target = (repeat ? steps.find(ofBlock) : steps[steps.findLastIndex(ofBlock) + 1]) as StudyStep;
  const next = {
    ...at.progress,
    runs: repeat ? { ...runs, [`${task}/${block}`]: run + 1 } : runs,
    paused: false,
  };
  const voided = at.withEvent(next, { type: 'void-block', task, block, run, reason, repeat });
  return at.enter(voided.progress, target, voided.records);
}

function remark(at: Moment, event: EventOf<'remark'>): Advance {
  if (at.progress.motion === null) return at.refused('nothing is recorded before consent');
  return at.withEvent(at.progress, { type: 'remark', text: checked(text(2000), event.text) });
}

function reload(at: Moment): Advance {
  const { step, place, progress } = at;
  if (!isPlayed(step) || !progress.running || !place) {
    return at.withEvent(runningOn(progress, at.now), { type: 'reload' });
  }
  const again = { ...progress, running: false, since: null, elapsed: 0, attempt: progress.attempt + 1 };
  return at.withEvent(again, { type: 'interrupted', place, step: step.id });
}

/** Returns null if the event does not fit the step. Throws a ValidationError for invalid content. */
type Handler<Event extends ProgressEvent = ProgressEvent> = (at: Moment, event: Event) => Advance | null;

const handlers: { readonly [Type in ProgressEvent['type']]: Handler<EventOf<Type>> } = {
  ...{ consent, demographics, calibrated, start, 'trial-finished': trialFinished, answer, submit, tick },
  ...{ pause, resume, stop, 'go-on': goOn, 'void-block': voidBlock, remark, reload },
};
