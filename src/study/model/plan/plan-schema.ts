import { identifier, integerBetween, numberBetween, text } from 'threepoint/core/validation/validation';
import * as v from 'valibot';
import { phrasesSchema } from '../phrases/phrase-schema';
import { languageTag, words } from '../phrases/words';
import { questionnaireSchema } from '../questionnaires/questionnaire-schema';
import { stoppingRuleSchema } from '../questionnaires/stopping-rule';
import { embodimentFields, estimatorSchema } from './embodiment';
import { remoteSchema } from './remote-setup';

export const planFormat = 'threepoint-study';
export const planVersion = 1;

const seconds = (max: number) => numberBetween(0, max);

const conditionSchema = v.strictObject({
  id: identifier,
  /** For the experimenter and the results; participants never see it. */
  label: text(60),
  ...embodimentFields,
});

const taskSchema = v.strictObject({
  id: identifier,
  /** As participants read it above each sheet. */
  title: words(60),
  game: v.picklist(['archery', 'ball'], 'expected archery or ball'),
  /** How many play together; they share the order of conditions. */
  groupSize: integerBetween(1, 6),
  /** Trials of one block, all under its condition. */
  repetitions: integerBetween(1, 20),
  /** Time limit of one trial. */
  trialSeconds: numberBetween(1, 3600),
  tutorial: v.strictObject({
    estimator: estimatorSchema,
    /** once: before the first block; each: before every block; never. */
    when: v.picklist(['never', 'once', 'each'], 'expected never, once or each'),
    seconds: numberBetween(1, 3600),
    restSeconds: seconds(3600),
  }),
  calibrateBeforeBlock: v.boolean('expected true or false'),
  /** Between the last trial of a block and its questionnaire. */
  restSeconds: seconds(3600),
  /** Ids of the plan's own questionnaires or of shipped ones, asked in this order. */
  questionnaire: v.union(
    [
      identifier,
      v.pipe(v.array(identifier), v.minLength(1, 'expected at least one'), v.maxLength(8, 'expected at most eight')),
    ],
    'expected the id of a questionnaire, or a list of ids',
  ),
  /** Time to answer each; who needs longer may finish, and it is recorded. */
  questionnaireSeconds: numberBetween(10, 7200),
});

/** The schema of a plan, but for what its parts demand of each other. */
export const planSchema = v.strictObject({
  /** Where editors find the schema; the program does not ask for it. */
  $schema: v.exactOptional(text(500)),
  format: v.literal(planFormat, `expected "${planFormat}": this is no study file`),
  version: v.literal(planVersion, `expected ${planVersion}, the version that this program reads`),
  id: identifier,
  title: words(120),
  /** Decides groups, cohorts, orders and layouts: the same seed gives the same study. */
  seed: integerBetween(0, 2 ** 31 - 1),
  participants: integerBetween(1, 999),
  /** Who may take a place: the holder of its own invitation (invited, where nothing is said), or of the study's one (open). */
  entry: v.exactOptional(v.picklist(['invited', 'open'], 'expected invited or open')),
  /** all: every order of the conditions; williams: a Latin square, for odd numbers two, each after each equally often. */
  orders: v.picklist(['all', 'williams'], 'expected all or williams'),
  conditions: v.pipe(
    v.array(conditionSchema, 'expected a list'),
    v.minLength(1, 'expected at least one condition'),
    v.maxLength(20, 'expected at most twenty conditions'),
  ),
  /** Compared between participants, who are divided among them: what each says holds under all conditions. */
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
  /** Those that participants may choose from; the first is the one that is chosen. One, English, where nothing is said. */
  languages: v.exactOptional(
    v.pipe(v.array(languageTag, 'expected a list of languages'), v.minLength(1, 'expected at least one language')),
  ),
  /** What the page itself says, in languages that it does not have, or in the study's own words; English where a key is not given. */
  phrases: v.exactOptional(phrasesSchema),
  questionnaires: v.exactOptional(
    v.pipe(v.array(questionnaireSchema, 'expected a list'), v.maxLength(20, 'expected at most twenty')),
  ),
  /** Participants take part elsewhere, with no one beside them; absent: an experimenter is there. */
  remote: v.exactOptional(remoteSchema),
  /** Who reaches one of these values is asked whether to stop. */
  askToStop: v.exactOptional(
    v.pipe(v.array(stoppingRuleSchema, 'expected a list'), v.maxLength(8, 'expected at most eight')),
  ),
  /** Measures that are tested as planned, a family for Holm's correction; all else is exploratory. "archery/nasa-tlx/raw", "archery/score". */
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
    /** Asked apart: whether tracked frames may be kept; null: this study never records them. */
    motion: v.nullable(words(1000)),
  }),
  /** After this many days the server deletes what was recorded. */
  retentionDays: integerBetween(1, 36_500),
});
