import { identifier, text } from 'threepoint/core';
import * as v from 'valibot';
import { words } from '../phrases/localized-text';
import { code, flag, limitedNumber } from './kinds/limits';
import type { AnswerForm } from './question-kind';
import { answerFormSchema } from './question-kinds';

const question = v.strictObject({
  id: code,
  text: words(400),
  /** The subject in a word or two, for headings of charts and tables. */
  about: v.exactOptional(text(40)),
  /** The form of its answer, if it differs from that of the questionnaire. */
  answer: v.exactOptional(answerFormSchema),
  optional: v.exactOptional(flag),
  /** Whether scales count from + to − answer. The answer is recorded as given. */
  reversed: v.exactOptional(flag),
});

const scale = v.strictObject({
  id: code,
  label: text(60),
  /**
   * count: the number of answers of at least `atLeast`; weighted-mean: each answer weighted by how often `choices`
   * chose its id.
   */
  method: v.picklist(['mean', 'sum', 'count', 'weighted-mean'], 'expected mean, sum, count or weighted-mean'),
  /** The ids of the questions; a repeated one counts twice. */
  questions: v.pipe(v.array(code, 'expected a list of questions'), v.minLength(1, 'expected at least one question')),
  /** The result is factor × (mean, sum or count) + offset; 1 and 0 if absent. */
  factor: v.exactOptional(limitedNumber),
  offset: v.exactOptional(limitedNumber),
  atLeast: v.exactOptional(limitedNumber),
  choices: v.exactOptional(
    v.pipe(v.array(code, 'expected a list of questions'), v.minLength(1, 'expected a question')),
  ),
});

export const questionnaireSchema = v.strictObject({
  id: identifier,
  title: words(80),
  /** The publication and its terms of use. */
  source: v.exactOptional(text(500)),
  /** The form of the answer to every question that has none of its own. */
  answer: v.exactOptional(answerFormSchema),
  questions: v.pipe(
    v.array(question, 'expected a list of questions'),
    v.minLength(1, 'expected at least one question'),
    v.maxLength(60, 'expected at most sixty questions'),
  ),
  /** The scales that are computed from the answers. */
  scales: v.exactOptional(v.array(scale, 'expected a list of scales')),
});

export type QuestionnaireFile = v.InferOutput<typeof questionnaireSchema>;
/** A value that is computed from the answers of a questionnaire. */
export type Scale = v.InferOutput<typeof scale>;
/** A question of a questionnaire with the form of its answer. */
export type Question = Omit<v.InferOutput<typeof question>, 'answer'> & { readonly answer: AnswerForm };
