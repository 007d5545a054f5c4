import { type Calibration, checked, text, ValidationError } from 'threepoint/core';
import type { PlainKey } from '../phrases/phrases';
import { isPlayed, type PlayedStep, type Schedule, type StudyStep, trialOf } from '../plan/schedule';
import type { Answer } from '../questionnaires/question-kind';
import { checkedAnswer, completeAnswers } from '../questionnaires/questionnaires';
import { reachedRule } from '../questionnaires/stopping-rule';
import { checkedDemographics } from '../records/demographics';
import { type Place, recordVersion, type StudyEvent, type StudyRecord } from '../records/study-record';
import { checkedOutcome, type TrialAbsence, type TrialOutcome } from '../records/trial-log';
import { currentStep, elapsedSeconds, type Progress, placeOf, runningOn } from './progress';
import { Rejection } from './rejection';
import type { TargetBlock } from './study-api';

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
  | { readonly type: 'submit' }
  | { readonly type: 'tick' }
  /** `by`: absent: the participant. */
  | { readonly type: 'pause'; readonly by?: 'experimenter' }
  /** The match of the started trial runs or stands at this second. */
  | { readonly type: 'match-clock'; readonly runs: boolean; readonly second: number }
  /** The match of the present trial waited for participants. */
  | { readonly type: 'absence'; readonly absence: TrialAbsence }
  /** The group finished the present trial without this participant. */
  | { readonly type: 'missed' }
  /** Ends the session at any step. */
  | { readonly type: 'stop'; readonly by: 'participant' | 'experimenter'; readonly reason?: string }
  /** Continues after the participant was asked, because of answers, whether to stop. */
  | { readonly type: 'go-on' }
  | { readonly type: 'resume'; readonly by?: 'experimenter' }
  /** Voids the present block if it is the intended one; repeat: it starts again, otherwise the next one follows. */
  | { readonly type: 'void-block'; readonly reason: string; readonly repeat: boolean; readonly of?: TargetBlock }
  /** The consent to motion was withdrawn on the withdrawal page, which the server has recorded. */
  | { readonly type: 'withdraw-motion' }
  | { readonly type: 'remark'; readonly text: string }
  /**
   * Reports that the page was reloaded, here or on another device. A running trial is void and repeated; everything
   * else continues.
   */
  | { readonly type: 'reload' };

export interface EventResult {
  readonly progress: Progress;
  /** The records to store and send, in this order. */
  readonly records: readonly StudyRecord[];
  /** Why nothing changed; null: the event was accepted. */
  readonly rejection: Rejection | null;
}

type EventOf<Type extends ProgressEvent['type']> = Extract<ProgressEvent, { type: Type }>;

/** The events that are accepted during a pause. */
const acceptedInPause: readonly ProgressEvent['type'][] = [
  'resume',
  'remark',
  'withdraw-motion',
  'void-block',
  'trial-finished',
  'match-clock',
  'absence',
  'missed',
  'reload',
  'tick',
  'stop',
  'go-on',
];

/** The events that are refused until a participant who may be unwell has decided whether to stop. */
const rejectedWhileAsked: readonly ProgressEvent['type'][] = ['start', 'calibrated', 'answer', 'submit'];

/**
 * Applies an event to a session at `now` [s since 1970]. An event that does not fit the step changes nothing and is
 * refused with a reason.
 */
export function applyEvent(schedule: Schedule, progress: Progress, event: ProgressEvent, now: number): EventResult {
  const session = new SessionAtEvent(schedule, progress, now);
  if (progress.paused && !acceptedInPause.includes(event.type))
    return session.reject('the session is paused', 'refused.paused');
  if (progress.unwell && rejectedWhileAsked.includes(event.type)) {
    return session.reject('the participant is asked whether to stop', 'refused.asked');
  }
  try {
    const next =
      (handlers[event.type] as Handler)(session, event) ??
      session.reject(`"${event.type}" does not fit the step "${session.step.id}"`);
    if (next.progress === progress) return next;
    return { ...next, progress: { ...next.progress, changes: progress.changes + 1 } };
  } catch (error) {
    if (!(error instanceof ValidationError)) throw error;
    return session.reject(error.message);
  }
}

/** A session at the time of an event; its methods return the possible results of the event. */
class SessionAtEvent {
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

  /** The fields that every record of this event has. */
  get recordFields() {
    const { study, participant } = this.schedule;
    return { version: recordVersion, study, participant, simulated: this.progress.simulated, at: this.now } as const;
  }

  /** Returns the id of a record of this attempt at the step, so that sending it twice stores it once. */
  recordId(kind: string): string {
    const suffix = this.place ? `@${this.place.run}.${this.place.attempt}` : '';
    return `${this.step.id}${suffix}:${kind}`;
  }

  reject(message: string, phrase: PlainKey | null = null): EventResult {
    return { progress: this.progress, records: [], rejection: new Rejection('conflict', message, { phrase }) };
  }

  accept(progress: Progress, records: readonly StudyRecord[] = []): EventResult {
    return { progress, records, rejection: null };
  }

  /** Returns the session with a record of what happened; nothing is recorded before consent, not even a pause. */
  withEvent(next: Progress, body: StudyEvent): EventResult {
    if (next.motion === null) return this.accept(next);
    const counted = { ...next, events: next.events + 1 };
    return this.accept(counted, [{ ...this.recordFields, kind: 'event', id: `event-${counted.events}`, body }]);
  }

  moveOn(from: Progress, records: readonly StudyRecord[] = []): EventResult {
    const { steps } = this.schedule;
    const next = steps.slice(steps.indexOf(this.step) + 1).find((step) => !isFinishedPractice(step, from));
    return this.enterStep(from, next as StudyStep, records);
  }

  enterStep(from: Progress, step: StudyStep, records: readonly StudyRecord[]): EventResult {
    const entered = this.atStep(from, step);
    if (step.kind !== 'end') return this.accept(entered, records);
    const finished = this.withEvent(entered, { type: 'finished' });
    return this.accept(finished.progress, [...records, ...finished.records]);
  }

  /**
   * Returns the session at the start of a step. Clocks of rests and questionnaires start at once, games and calibration
   * wait for a start.
   */
  atStep(from: Progress, step: StudyStep): Progress {
    const running = step.kind === 'rest' || step.kind === 'questionnaire';
    const since = running && !from.paused ? this.now : null;
    const fresh = { waiting: false, voided: false, elapsed: 0, draft: {}, attempt: 1 };
    return { ...from, ...fresh, step: step.id, running, since };
  }
}

const blockKey = ({ task, block }: { readonly task: string; readonly block: number }): string => `${task}/${block}`;

const isPractice = (step: StudyStep): boolean =>
  step.kind === 'tutorial' || (step.kind === 'rest' && step.id.endsWith('/rest-after-tutorial'));

/** Returns whether a step is the practice of a repeated block in which it was finished before. */
const isFinishedPractice = (step: StudyStep, { practised }: Progress): boolean =>
  'task' in step && isPractice(step) && practised.includes(blockKey(step));

function consent(session: SessionAtEvent, { version, motion, language }: EventOf<'consent'>): EventResult | null {
  if (session.step.kind !== 'consent') return null;
  const shown = session.schedule.consentVersion;
  if (version !== shown) {
    throw new ValidationError('version', `consent was given to text ${version}, but the study shows ${shown}`);
  }
  const chosen = language === undefined ? {} : { language };
  const body = { version, given: true, motion, at: session.now, ...chosen } as const;
  return session.moveOn({ ...session.progress, motion, ...chosen }, [
    { ...session.recordFields, kind: 'consent', id: 'consent', body },
  ]);
}

function demographics(session: SessionAtEvent, event: EventOf<'demographics'>): EventResult | null {
  if (session.step.kind !== 'demographics') return null;
  const body = checkedDemographics(event.demographics);
  return session.moveOn(session.progress, [
    { ...session.recordFields, kind: 'demographics', id: 'demographics', body },
  ]);
}

function calibrated(session: SessionAtEvent, { calibration }: EventOf<'calibrated'>): EventResult | null {
  const { place } = session;
  if (session.step.kind !== 'calibration' || !place) return null;
  const { eyeHeight, armSpan, gazePitch, handTilts } = calibration;
  const body = {
    place,
    eyeHeight,
    armSpan,
    ...(gazePitch !== undefined && { gazePitch }),
    ...(handTilts !== undefined && { handTilts }),
  };
  return session.moveOn(session.progress, [
    { ...session.recordFields, kind: 'calibration', id: session.recordId('calibration'), body },
  ]);
}

function start(session: SessionAtEvent): EventResult | null {
  if (!isPlayed(session.step) || session.progress.running) return null;
  return session.accept({ ...session.progress, running: true, since: session.now, elapsed: 0 });
}

function trialFinished(session: SessionAtEvent, { outcome }: EventOf<'trial-finished'>): EventResult | null {
  const { step, place, progress } = session;
  if (!isPlayed(step) || !progress.running || !place) return null;
  const body = {
    place,
    condition: step.kind === 'trial' ? step.condition : null,
    estimator: step.embodiment.estimator,
    repetition: step.kind === 'trial' ? step.repetition : 1,
    group: session.schedule.groups[step.task]?.number ?? 1,
    outcome: checkedOutcome(outcome),
  };
  return session.moveOn(progress, [{ ...session.recordFields, kind: 'trial', id: session.recordId('trial'), body }]);
}

function answer(session: SessionAtEvent, { question, value }: EventOf<'answer'>): EventResult | null {
  const { step, progress } = session;
  if (step.kind !== 'questionnaire') return null;
  const { [question]: _, ...others } = progress.draft;
  const given = value === null ? {} : { [question]: checkedAnswer(step.questionnaire, question, value) };
  return session.accept({ ...progress, draft: { ...others, ...given } });
}

function submit(session: SessionAtEvent): EventResult | null {
  const { step, place, progress } = session;
  if (step.kind !== 'questionnaire' || !place) return null;
  const answers = completeAnswers(step.questionnaire, progress.draft);
  const seconds = elapsedSeconds(progress, session.now);
  const { embodiment } = trialOf(session.schedule, step) as PlayedStep;
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
  const handedIn = [{ ...session.recordFields, kind: 'answers', id: session.recordId('answers'), body } as const];
  const unwell = reachedRule(session.schedule.askToStop, step.questionnaire, body.answers);
  if (!unwell) return session.moveOn(progress, handedIn);
  const { questionnaire, measure, value } = unwell;
  const recorded = session.withEvent(
    { ...progress, unwell: true },
    { type: 'unwell', place, questionnaire, measure, value },
  );
  return session.moveOn(recorded.progress, [...handedIn, ...recorded.records]);
}

function tick(session: SessionAtEvent): EventResult {
  const { step, progress } = session;
  const over = step.kind === 'rest' && !progress.paused && elapsedSeconds(progress, session.now) >= step.seconds;
  return over ? session.moveOn(progress) : session.accept(runningOn(progress, session.now));
}

function matchClock(session: SessionAtEvent, { runs, second }: EventOf<'match-clock'>): EventResult | null {
  const { step, now, progress } = session;
  if (!isPlayed(step) || !progress.running) return null;
  const since = runs && !progress.paused ? now : null;
  return session.accept({ ...progress, waiting: !runs, since, elapsed: second });
}

function absence(session: SessionAtEvent, event: EventOf<'absence'>): EventResult | null {
  const { step, place, progress } = session;
  if (!isPlayed(step) || !place) return null;
  return session.withEvent(progress, { type: 'absence', place, ...event.absence });
}

function missed(session: SessionAtEvent): EventResult | null {
  const { step, place, progress } = session;
  if (!isPlayed(step) || !place) return null;
  const recorded = session.withEvent(progress, { type: 'missed', place, step: step.id });
  return session.moveOn(recorded.progress, recorded.records);
}

function pause(session: SessionAtEvent, { by }: EventOf<'pause'>): EventResult | null {
  const { step, progress } = session;
  if (step.kind === 'end') return null;
  const stopped = { ...progress, paused: true, since: null, elapsed: elapsedSeconds(progress, session.now) };
  return session.withEvent(stopped, { type: 'pause', by: by ?? 'participant' });
}

function stop(session: SessionAtEvent, { by, reason }: EventOf<'stop'>): EventResult | null {
  const { step, place, progress, schedule } = session;
  if (step.kind === 'end') return null;
  if (progress.motion === null) return session.reject('nothing is recorded before consent');
  const stated = reason === undefined ? {} : { reason: checked(text(500), reason) };
  const recorded = session.withEvent(
    { ...progress, unwell: false, stopped: true, paused: false },
    { type: 'stop', by, ...stated, place, step: step.id },
  );
  return session.accept(session.atStep(recorded.progress, schedule.steps.at(-1) as StudyStep), recorded.records);
}

/**
 * Continues after the participant decided not to stop. The clock of a questionnaire starts now, because it was not
 * shown before. The clock of a rest has run in the meantime.
 */
function goOn(session: SessionAtEvent): EventResult | null {
  if (!session.progress.unwell) return null;
  const decided = { ...session.progress, unwell: false };
  const begins = session.step.kind === 'questionnaire' ? session.atStep(decided, session.step) : decided;
  return session.withEvent(begins, { type: 'go-on' });
}

function resume(session: SessionAtEvent, { by }: EventOf<'resume'>): EventResult | null {
  const { progress } = session;
  if (!progress.paused) return null;
  return session.withEvent(
    { ...progress, paused: false, since: progress.running && !progress.waiting ? session.now : null },
    { type: 'resume', by: by ?? 'participant' },
  );
}

function voidBlock(session: SessionAtEvent, event: EventOf<'void-block'>): EventResult | null {
  if (!session.place) return null;
  const { repeat, of } = event;
  const { task, block, run } = session.place;
  if (of && (of.task !== task || of.block !== block)) {
    return session.reject(`block ${of.block} of "${of.task}", which the command is for, is not under way`);
  }
  const { steps } = session.schedule;
  const { runs, practised } = session.progress;
  const reason = checked(text(500), event.reason);
  const ofBlock = (step: StudyStep) => 'task' in step && step.task === task && step.block === block;
  const isPastPractice = steps.findLastIndex((step) => ofBlock(step) && isPractice(step)) < steps.indexOf(session.step);
  const key = blockKey(session.place);
  const next = {
    ...session.progress,
    runs: repeat ? { ...runs, [key]: run + 1 } : runs,
    practised: repeat && isPastPractice ? [...new Set([...practised, key])] : practised,
    paused: false,
  };
  const isSkipped = (step: StudyStep) => isFinishedPractice(step, next);
  const target = (
    repeat ? steps.find((step) => ofBlock(step) && !isSkipped(step)) : steps[steps.findLastIndex(ofBlock) + 1]
  ) as StudyStep;
  const voided = session.withEvent(next, { type: 'void-block', task, block, run, reason, repeat });
  const entered = session.enterStep(voided.progress, target, voided.records);
  return { ...entered, progress: { ...entered.progress, voided: true } };
}

function remark(session: SessionAtEvent, event: EventOf<'remark'>): EventResult {
  if (session.progress.motion === null) return session.reject('nothing is recorded before consent');
  return session.withEvent(session.progress, { type: 'remark', text: checked(text(2000), event.text) });
}

function withdrawMotion({ progress, accept }: SessionAtEvent): EventResult {
  return accept({ ...progress, motion: progress.motion === null ? null : false });
}

function reload(session: SessionAtEvent): EventResult {
  const { step, place, progress } = session;
  if (!isPlayed(step) || !progress.running || !place) {
    return session.withEvent(runningOn(progress, session.now), { type: 'reload' });
  }
  const attempt = progress.attempt + 1;
  const again = { ...progress, waiting: false, running: false, since: null, elapsed: 0, attempt };
  return session.withEvent(again, { type: 'interrupted', place, step: step.id });
}

/** Returns null if the event does not fit the step. Throws a ValidationError for invalid content. */
type Handler<Event extends ProgressEvent = ProgressEvent> = (
  session: SessionAtEvent,
  event: Event,
) => EventResult | null;

const handlers: { readonly [Type in ProgressEvent['type']]: Handler<EventOf<Type>> } = {
  ...{ consent, demographics, calibrated, start, 'trial-finished': trialFinished, answer, submit, tick },
  ...{ 'match-clock': matchClock, absence, missed, 'withdraw-motion': withdrawMotion },
  ...{ pause, resume, stop, 'go-on': goOn, 'void-block': voidBlock, remark, reload },
};
