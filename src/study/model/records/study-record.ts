import {
  checked,
  identifier,
  integerBetween,
  numberBetween,
  participantId,
  text,
  threePointNames,
  ValidationError,
} from 'threepoint/core';
import * as v from 'valibot';
import { languageTag } from '../phrases/localized-text';
import type { StudyPlan } from '../plan/plan';
import { checkedAnswers, questionnaireNamed } from '../questionnaires/questionnaires';
import { demographicsSchema } from './demographics';
import { absenceSchema, calibrationEntries, outcomeSchema } from './trial-log';

/** The version of stored records, which increases with every change of meaning. */
export const recordVersion = 1;
/** The longest record as JSON [characters]. */
export const longestRecord = 65_536;

const blockNumber = integerBetween(1, 1000);

const placeSchema = v.object({
  task: identifier,
  /** The position of the condition in the participant's order, from 1. */
  block: blockNumber,
  /** Counted from 1; a voided and repeated block has another run. */
  run: blockNumber,
  /** Counted from 1; an interrupted trial has another attempt. */
  attempt: blockNumber,
});

const author = v.picklist(['participant', 'experimenter']);

const eventSchema = v.variant('type', [
  v.object({
    type: v.literal('void-block'),
    task: identifier,
    block: blockNumber,
    run: blockNumber,
    reason: text(500),
    repeat: v.boolean(),
  }),
  v.object({ type: v.literal('interrupted'), place: placeSchema, step: text(120) }),
  /** The match of the group waited for participants. */
  v.object({ type: v.literal('absence'), place: placeSchema, ...absenceSchema.entries }),
  /** The group finished the match without this participant. */
  v.object({ type: v.literal('missed'), place: placeSchema, step: text(120) }),
  /** Answers reached a stopping rule of the plan. */
  v.object({
    type: v.literal('unwell'),
    place: placeSchema,
    questionnaire: identifier,
    measure: v.string(),
    value: v.number(),
  }),
  /** The participant continued after that. */
  v.object({ type: v.literal('go-on') }),
  /** The session was ended at this step, before its end. */
  v.object({
    type: v.literal('stop'),
    by: author,
    reason: v.exactOptional(text(500)),
    place: v.nullable(placeSchema),
    step: text(120),
  }),
  v.object({ type: v.literal('pause'), by: author }),
  v.object({ type: v.literal('resume'), by: author }),
  /** The consent to motion was withdrawn with the code, and the recordings were deleted. */
  v.object({ type: v.literal('motion-withdrawn') }),
  v.object({ type: v.literal('remark'), text: text(2000) }),
  v.object({ type: v.literal('reload') }),
  v.object({ type: v.literal('finished') }),
]);

/** The consent to a version of the text. A refusal is not recorded. */
const consentSchema = v.object({
  /** The version of the text that was shown. */
  version: text(40),
  given: v.literal(true, 'nothing is recorded without consent'),
  /** Whether tracking frames may be kept. */
  motion: v.boolean('expected true or false'),
  /** The time on the participant's device, in seconds since 1970. */
  at: numberBetween(0, 1e11),
  /** The language of the text; absent: the study has only one. */
  language: v.exactOptional(languageTag),
});

/** The types of events in a session, apart from questions and trials. */
export const eventTypes = eventSchema.options.map(({ entries }) => entries.type.literal);

const envelope = {
  version: v.literal(recordVersion, `expected ${recordVersion}, the version that this program reads`),
  /** Unique for the participant, so that a record that is sent twice is stored once. */
  id: v.pipe(
    v.string('expected text'),
    v.regex(/^[a-z0-9][a-z0-9/.:@-]{0,119}$/, 'expected small letters, digits and / . : @ -'),
  ),
  study: identifier,
  participant: participantId,
  /** Whether a program made it instead of a person. */
  simulated: v.boolean('expected true or false'),
  /** The time on the participant's device, in seconds since 1970. */
  at: numberBetween(0, 1e11),
};

const recordSchema = v.variant('kind', [
  v.object({ ...envelope, kind: v.literal('consent'), body: consentSchema }),
  v.object({ ...envelope, kind: v.literal('demographics'), body: demographicsSchema }),
  v.object({
    ...envelope,
    kind: v.literal('calibration'),
    body: v.object({ place: placeSchema, ...calibrationEntries }),
  }),
  v.object({
    ...envelope,
    kind: v.literal('trial'),
    body: v.object({
      place: placeSchema,
      /** null: a tutorial, which is not evaluated. */
      condition: v.nullable(identifier),
      estimator: v.picklist(threePointNames),
      repetition: blockNumber,
      group: blockNumber,
      outcome: outcomeSchema,
    }),
  }),
  v.object({
    ...envelope,
    kind: v.literal('answers'),
    body: v.object({
      place: placeSchema,
      condition: identifier,
      estimator: v.picklist(threePointNames),
      questionnaire: identifier,
      /** The language of the questionnaire; absent: the study has only one. */
      language: v.exactOptional(languageTag),
      answers: v.record(v.string(), v.union([v.number(), v.string()], 'expected a number or a text')),
      /** The time from the first question to handing in, without pauses. */
      seconds: numberBetween(0, 1e7),
      overtime: v.boolean(),
    }),
  }),
  v.object({ ...envelope, kind: v.literal('event'), body: eventSchema }),
]);

export type Place = v.InferOutput<typeof placeSchema>;
export type StudyEvent = v.InferOutput<typeof eventSchema>;
/** A record about a participant, complete in itself. */
export type StudyRecord = v.InferOutput<typeof recordSchema>;

/** The fields that the server adds to a record. They are absent in records that no server has stored. */
const arrivalSchema = v.object({
  /** The token with which the record came. */
  author: v.exactOptional(author),
  /** Seconds since 1970 by the server's clock. */
  receivedAt: v.exactOptional(v.number()),
});

export type RecordAuthor = NonNullable<v.InferOutput<typeof arrivalSchema>['author']>;
export type StoredRecord = StudyRecord & v.InferOutput<typeof arrivalSchema>;
export type DemographicsRecord = Extract<StudyRecord, { kind: 'demographics' }>;
export type TrialRecord = Extract<StudyRecord, { kind: 'trial' }>;

/** Returns the result of a check; its ValidationErrors name the field below `field`. */
export function within<T>(field: string, check: () => T): T {
  try {
    return check();
  } catch (error) {
    if (!(error instanceof ValidationError)) throw error;
    throw new ValidationError(error.field ? `${field}.${error.field}` : field, error.complaint);
  }
}

/** Returns a record from an export, with the fields that the server added; throws as `checkedRecord` does. */
export const exportedRecord = (value: unknown, plan: Pick<StudyPlan, 'questionnaires'>): StoredRecord => ({
  ...checkedRecord(value, plan),
  ...checked(arrivalSchema, value),
});

/**
 * Returns a record of this study that may be stored; throws a ValidationError that names the field, also for one that
 * is too long.
 */
export function checkedRecord(value: unknown, plan: Pick<StudyPlan, 'questionnaires'>): StudyRecord {
  const record = checked(recordSchema, value);
  const length = JSON.stringify(value).length;
  if (length > longestRecord)
    throw new ValidationError('', `a record has at most ${longestRecord} characters, this one ${length}`);
  if (record.kind !== 'answers') return record;
  const { questionnaire, answers } = record.body;
  const asked = questionnaireNamed(plan, questionnaire);
  if (!asked) throw new ValidationError('body.questionnaire', `the study has no questionnaire "${questionnaire}"`);
  return {
    ...record,
    body: { ...record.body, answers: within('body.answers', () => ({ ...checkedAnswers(asked, answers) })) },
  };
}
