import { identifier, integerBetween, numberBetween, text } from 'threepoint/core';
import { gameNames } from 'threepoint-games/all';
import * as v from 'valibot';
import { languageTag, words } from '../phrases/localized-text';
import { phrasesSchema } from '../phrases/phrase-schema';
import { questionnaireSchema } from '../questionnaires/questionnaire-schema';
import { stoppingRuleSchema } from '../questionnaires/stopping-rule';
import { embodimentFields, estimatorSchema } from './embodiment';
import { hypothesisSchema } from './hypotheses';
import { remoteSchema } from './remote-setup';

export const planFormat = 'threepoint-study';
export const planVersion = 1;

const seconds = (max: number) => numberBetween(0, max);

const conditionSchema = v.strictObject({
  id: identifier,
  /** The name for the experimenter and the results; participants never see it. */
  label: text(60),
  ...embodimentFields,
});

const taskSchema = v.strictObject({
  id: identifier,
  /** The title that participants read above each sheet. */
  title: words(60),
  game: v.picklist(gameNames),
  /** The number of participants who play together; they share the order of conditions. */
  groupSize: integerBetween(1, 6),
  /** The number of trials in a block, all under its condition. */
  repetitions: integerBetween(1, 20),
  trialSeconds: numberBetween(1, 3600),
  /** What a match of a group does when a participant is away; absent: see `absenceRuleOf`. */
  absence: v.exactOptional(
    v.strictObject({
      waitSeconds: numberBetween(5, 1800),
      /** repeat: the match is void for all and played again; end: it ends, and its trials are not counted. */
      after: v.picklist(['repeat', 'end'], 'expected repeat or end'),
    }),
  ),
  tutorial: v.strictObject({
    estimator: estimatorSchema,
    /** once: before the first block; each: before every block; never. */
    when: v.picklist(['never', 'once', 'each'], 'expected never, once or each'),
    seconds: numberBetween(1, 3600),
    restSeconds: seconds(3600),
  }),
  calibrateBeforeBlock: v.boolean('expected true or false'),
  /** The rest between the last trial of a block and its questionnaire [s]. */
  restSeconds: seconds(3600),
  /** The ids of the plan's questionnaires or of shipped ones, in the order asked. */
  questionnaire: v.union(
    [
      identifier,
      v.pipe(v.array(identifier), v.minLength(1, 'expected at least one'), v.maxLength(8, 'expected at most eight')),
    ],
    'expected the id of a questionnaire, or a list of ids',
  ),
  /** The time to answer each [s]; participants may take longer, which is recorded. */
  questionnaireSeconds: numberBetween(10, 7200),
});

/** The schema of a plan, without the consistency of its parts. */
export const planSchema = v.strictObject({
  /** The address of the schema for editors; the program ignores it. */
  $schema: v.exactOptional(text(500)),
  format: v.literal(planFormat, `expected "${planFormat}": this is not a study file`),
  version: v.literal(planVersion, `expected ${planVersion}, the version that this program reads`),
  id: identifier,
  title: words(120),
  /** The seed of groups, cohorts, orders and layouts: the same seed gives the same study. */
  seed: integerBetween(0, 2 ** 31 - 1),
  participants: integerBetween(1, 999),
  /** Whether each place has its own invitation (invited, the default), or all places have one (open). */
  entry: v.exactOptional(v.picklist(['invited', 'open'], 'expected invited or open')),
  /**
   * all: every order of the conditions; williams: a Latin square, two for odd numbers, with each condition after each
   * other equally often.
   */
  orders: v.picklist(['all', 'williams'], 'expected all or williams'),
  conditions: v.pipe(
    v.array(conditionSchema, 'expected a list'),
    v.minLength(1, 'expected at least one condition'),
    v.maxLength(20, 'expected at most twenty conditions'),
  ),
  /** Groups that are compared between participants; the properties of a cohort hold under all conditions. */
  cohorts: v.exactOptional(
    v.pipe(
      v.array(conditionSchema, 'expected a list'),
      v.minLength(2, 'expected at least two cohorts to compare'),
      v.maxLength(8, 'expected at most eight cohorts'),
    ),
  ),
  tasks: v.pipe(
    v.array(taskSchema, 'expected a list'),
    v.minLength(1, 'expected at least one task'),
    v.maxLength(8, 'expected at most eight tasks'),
  ),
  /** The languages that participants may choose, the first as default; English if absent. */
  languages: v.exactOptional(
    v.pipe(v.array(languageTag, 'expected a list of languages'), v.minLength(1, 'expected at least one language')),
  ),
  /** Phrases of the page in further languages, or of the study's choice; English for keys without one. */
  phrases: v.exactOptional(phrasesSchema),
  questionnaires: v.exactOptional(
    v.pipe(v.array(questionnaireSchema, 'expected a list'), v.maxLength(20, 'expected at most twenty')),
  ),
  /** The terms for participants who take part elsewhere and alone; absent: an experimenter is present. */
  remote: v.exactOptional(remoteSchema),
  /** The values from which a participant is asked whether to stop. */
  askToStop: v.exactOptional(
    v.pipe(v.array(stoppingRuleSchema, 'expected a list'), v.maxLength(8, 'expected at most eight')),
  ),
  /** The hypotheses; their measures are planned. */
  hypotheses: v.exactOptional(
    v.pipe(v.array(hypothesisSchema, 'expected a list of hypotheses'), v.maxLength(20, 'expected at most twenty')),
  ),
  /**
   * Further planned measures, with those of the hypotheses a family for Holm's correction; all others are exploratory.
   * "archery/nasa-tlx/raw", "archery/score".
   */
  planned: v.exactOptional(
    v.pipe(v.array(text(200), 'expected a list of measures'), v.maxLength(40, 'expected at most forty measures')),
  ),
  consent: v.strictObject({
    /** Changes with every change of the text. */
    version: text(40),
    title: words(120),
    paragraphs: v.pipe(
      v.array(words(2000), 'expected a list of paragraphs'),
      v.minLength(1, 'expected at least one paragraph'),
      v.maxLength(40, 'expected at most forty paragraphs'),
    ),
    /** The separate question whether tracking frames may be kept; null: this study never records them. */
    motion: v.nullable(words(1000)),
  }),
  /** The number of days after which the server deletes the records. */
  retentionDays: integerBetween(1, 36_500),
});
