import { ValidationError } from 'threepoint/core';
import * as v from 'valibot';
import { words } from '../../phrases/localized-text';
import type { QuestionKind } from '../question-kind';
import { code } from './limits';

const schema = v.strictObject({
  kind: v.literal('choice'),
  options: v.pipe(
    v.array(v.strictObject({ value: code, label: words(80) }), 'expected a list of options'),
    v.minLength(2, 'expected at least two options'),
    v.maxLength(10, 'expected at most ten options'),
  ),
});

export type ChoiceForm = v.InferOutput<typeof schema>;

declare module '../question-kind' {
  interface AnswerForms {
    choice: ChoiceForm;
  }
}

const valuesOf = ({ options }: ChoiceForm): readonly string[] => options.map(({ value }) => value);

export const choice: QuestionKind<ChoiceForm> = {
  kind: 'choice',
  schema,
  check(form, field) {
    const values = valuesOf(form);
    values.forEach((value, index) => {
      const first = values.indexOf(value);
      if (first !== index) {
        throw new ValidationError(`${field}.options[${index}].value`, `"${value}" is the value of option ${first} too`);
      }
    });
  },
  answer: (form) => v.picklist(valuesOf(form), `expected one of ${valuesOf(form).join(', ')}`),
  range: () => null,
  options: valuesOf,
  texts: ({ options }) => options.map(({ label }, index) => [`options[${index}].label`, label]),
  columns: ({ options }, inWords) => ({
    answers: options.map(({ value, label }) => `${value}: ${inWords(label)}`).join('; '),
  }),
  simulate: ({ options }, _, uniform) => (options[Math.floor(uniform() * options.length)] ?? options[0])?.value ?? '',
};
