import { ValidationError } from 'threepoint/core';
import { isPlayed, type Schedule, type StudyStep, trialOf } from '../plan/schedule';
import type { Place, StudyRecord } from './study-record';

type BlockStep = Extract<StudyStep, { task: string }>;
type RecordOf<Kind extends StudyRecord['kind']> = Extract<StudyRecord, { kind: Kind }>;

/** Returns the steps of the block at a place; throws a ValidationError if the participant has no such block. */
function blockOf({ steps, participant }: Schedule, { task, block }: Pick<Place, 'task' | 'block'>): BlockStep[] {
  const found = steps.filter((step): step is BlockStep => 'task' in step && step.task === task && step.block === block);
  if (found.length > 0) return found;
  throw new ValidationError('body.place', `${participant} has no block ${block} of "${task}"`);
}

/** Throws a ValidationError that names the first field whose value differs from that of the schedule. */
function rejectOthers(body: object, scheduled: Readonly<Record<string, unknown>>): void {
  for (const [field, expected] of Object.entries(scheduled)) {
    const found = (body as Readonly<Record<string, unknown>>)[field];
    if (found !== expected)
      throw new ValidationError(`body.${field}`, `the schedule has ${expected} here, not ${found}`);
  }
}

function rejectTrial({ body }: RecordOf<'trial'>, schedule: Schedule): void {
  const { place, condition, repetition, outcome } = body;
  const played = blockOf(schedule, place).filter(isPlayed);
  const kind = condition === null ? 'tutorial' : 'trial';
  const step = played.find((one) => one.kind === kind && (one.kind === 'tutorial' || one.repetition === repetition));
  if (!step) throw new ValidationError('body.repetition', `the block has no ${kind} ${repetition}`);
  rejectOthers(body, {
    condition: step.kind === 'trial' ? step.condition : null,
    estimator: step.embodiment.estimator,
    repetition: step.kind === 'trial' ? step.repetition : 1,
    group: schedule.groups[place.task]?.number ?? 1,
  });
  if (outcome.score > outcome.maximum) {
    throw new ValidationError('body.outcome.score', `expected at most the maximum, ${outcome.maximum}`);
  }
}

function rejectAnswers({ body }: RecordOf<'answers'>, schedule: Schedule): void {
  const { place, questionnaire } = body;
  const asked = blockOf(schedule, place).find(
    (step) => step.kind === 'questionnaire' && step.questionnaire.id === questionnaire,
  );
  if (!asked) throw new ValidationError('body.questionnaire', `the block does not ask "${questionnaire}"`);
  const trial = trialOf(schedule, asked);
  rejectOthers(body, { condition: trial?.condition, estimator: trial?.embodiment.estimator });
}

function rejectEvent({ body }: RecordOf<'event'>, schedule: Schedule): void {
  if (body.type === 'void-block') blockOf(schedule, body);
  if ('place' in body && body.place) blockOf(schedule, body.place);
  if ('step' in body && !schedule.steps.some(({ id }) => id === body.step)) {
    throw new ValidationError('body.step', `${schedule.participant} has no step "${body.step}"`);
  }
}

/**
 * Throws a ValidationError that names the field of a record that no page makes under this schedule: a place, condition,
 * estimator, group, questionnaire or step that the participant does not have, or a score above the maximum.
 */
export function rejectUnscheduled(record: StudyRecord, schedule: Schedule): void {
  if (record.kind === 'trial') rejectTrial(record, schedule);
  else if (record.kind === 'answers') rejectAnswers(record, schedule);
  else if (record.kind === 'calibration') blockOf(schedule, record.body.place);
  else if (record.kind === 'event') rejectEvent(record, schedule);
}

/** Throws a ValidationError if this is not the id of the record of a round or practice in this schedule. */
export function rejectUnscheduledTrial(id: string, { steps, participant }: Schedule): void {
  const [step] = id.split('@');
  if (steps.some((one) => isPlayed(one) && one.id === step)) return;
  throw new ValidationError('trial', `${participant} does not play "${step}"`);
}
