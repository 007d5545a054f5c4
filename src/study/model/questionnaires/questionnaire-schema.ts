import { identifier, integerBetween, numberBetween, text } from 'threepoint/core/validation/validation';
import * as v from 'valibot';
import { words } from '../phrases/words';

const limit = 1_000_000;
const number = numberBetween(-limit, limit);
const flag = v.boolean('expected true or false');

/** Names of questions and of what is chosen: they go into tables and addresses of the screen. */
const code = v.pipe(
  v.string('expected text'),
  v.regex(
    /^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$/,
    'expected letters, digits, hyphens and underscores, at most 32, a letter or digit first',
  ),
);

const ends = v.strictObject({ low: words(60), high: words(60) });

const likert = v.strictObject({
  kind: v.literal('likert'),
  /** The first point and the last, both whole. */
  from: integerBetween(-1000, 1000),
  to: integerBetween(-1000, 1000),
  /** Between two points; 1 where nothing is said. */
  step: v.exactOptional(integerBetween(1, 1000)),
  /** Below the ends of the scale. */
  ends: v.exactOptional(ends),
  /** Of every point, the first to the last. */
  labels: v.exactOptional(v.array(words(40), 'expected a list of labels')),
});

/** A visual analogue scale: a line without points. */
const slider = v.strictObject({
  kind: v.literal('slider'),
  from: number,
  to: number,
  step: v.exactOptional(numberBetween(0.001, limit)),
  ends,
});

const choice = v.strictObject({
  kind: v.literal('choice'),
  options: v.pipe(
    v.array(v.strictObject({ value: code, label: words(80) }), 'expected a list of options'),
    v.minLength(2, 'expected at least two options'),
    v.maxLength(10, 'expected at most ten options'),
  ),
});

const typedNumber = v.strictObject({
  kind: v.literal('number'),
  from: number,
  to: number,
  whole: v.exactOptional(flag),
  unit: v.exactOptional(words(20)),
});

const typedText = v.strictObject({ kind: v.literal('text'), maxLength: integerBetween(1, 1000) });

const form = v.variant(
  'kind',
  [likert, slider, choice, typedNumber, typedText],
  'expected likert, slider, choice, number or text',
);

const question = v.strictObject({
  id: code,
  text: words(400),
  /** What it asks about, in a word or two: headings of charts and tables. */
  about: v.exactOptional(text(40)),
  /** How it is answered, where that is not as the questionnaire says for all. */
  answer: v.exactOptional(form),
  /** May stay without an answer. */
  optional: v.exactOptional(flag),
  /** Counts turned round in scales: from + to − answer. What is recorded is the answer as given. */
  reversed: v.exactOptional(flag),
});

const scale = v.strictObject({
  id: code,
  label: text(60),
  /** count: how many answers are at least `atLeast`; weighted-mean: each weighted by how often `choices` chose its id. */
  method: v.picklist(['mean', 'sum', 'count', 'weighted-mean'], 'expected mean, sum, count or weighted-mean'),
  /** Ids; a question named twice counts twice. */
  questions: v.pipe(v.array(code, 'expected a list of questions'), v.minLength(1, 'expected at least one question')),
  /** The result is factor × (mean, sum or count) + offset; 1 and 0 where nothing is said. */
  factor: v.exactOptional(number),
  offset: v.exactOptional(number),
  atLeast: v.exactOptional(number),
  choices: v.exactOptional(
    v.pipe(v.array(code, 'expected a list of questions'), v.minLength(1, 'expected a question')),
  ),
});

/** The schema of a questionnaire as a file says it. */
export const questionnaireSchema = v.strictObject({
  id: identifier,
  title: words(80),
  /** Where it was published, and on what terms. */
  source: v.exactOptional(text(500)),
  /** How every question is answered that says nothing of its own. */
  answer: v.exactOptional(form),
  questions: v.pipe(
    v.array(question, 'expected a list of questions'),
    v.minLength(1, 'expected at least one question'),
    v.maxLength(60, 'expected at most sixty questions'),
  ),
  /** What is computed from the answers. */
  scales: v.exactOptional(v.array(scale, 'expected a list of scales')),
});

/** A questionnaire as a file says it. */
export type QuestionnaireFile = v.InferOutput<typeof questionnaireSchema>;
/** How a question is answered. */
export type AnswerForm = v.InferOutput<typeof form>;
/** What is computed from the answers of a questionnaire. */
export type Scale = v.InferOutput<typeof scale>;
/** One question of a questionnaire, with how it is answered. */
export type Question = Omit<v.InferOutput<typeof question>, 'answer'> & { readonly answer: AnswerForm };
