import { integerBetween } from 'threepoint/core';
import * as v from 'valibot';
import type { QuestionKind } from '../question-kind';

const schema = v.strictObject({ kind: v.literal('text'), maxLength: integerBetween(1, 1000) });

export type TextForm = v.InferOutput<typeof schema>;

declare module '../question-kind' {
  interface AnswerForms {
    text: TextForm;
  }
}

export const text: QuestionKind<TextForm> = {
  kind: 'text',
  schema,
  answer: ({ maxLength }) =>
    v.custom<string>(
      (value) => typeof value === 'string' && value.trim() !== '' && value.length <= maxLength,
      `expected text of at most ${maxLength} characters`,
    ),
  range: () => null,
  options: () => null,
  texts: () => [],
  parse: (typed) => typed,
  columns: ({ maxLength }) => ({ answers: `at most ${maxLength} characters` }),
  simulate: ({ maxLength }) => 'SIMULATED'.slice(0, maxLength),
};
