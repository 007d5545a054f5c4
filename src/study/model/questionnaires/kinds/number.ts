import * as v from 'valibot';
import { words } from '../../phrases/localized-text';
import type { QuestionKind } from '../question-kind';
import { flag, limitedNumber } from './limits';
import { checkRange } from './scale-kind';

const schema = v.strictObject({
  kind: v.literal('number'),
  from: limitedNumber,
  to: limitedNumber,
  whole: v.exactOptional(flag),
  unit: v.exactOptional(words(20)),
});

export type NumberForm = v.InferOutput<typeof schema>;

declare module '../question-kind' {
  interface AnswerForms {
    number: NumberForm;
  }
}

export const number: QuestionKind<NumberForm> = {
  kind: 'number',
  schema,
  check: checkRange,
  answer: ({ from, to, whole = false }) =>
    v.custom<number>(
      (value) => typeof value === 'number' && value >= from && value <= to && (!whole || Number.isInteger(value)),
      `expected a ${whole ? 'whole ' : ''}number from ${from} to ${to}`,
    ),
  range: ({ from, to }) => [from, to],
  options: () => null,
  texts: ({ unit }) => (unit === undefined ? [] : [['unit', unit]]),
  parse: (typed) => Number(typed.replace('−', '-').replace(',', '.')),
  columns: ({ from, to, unit }, inWords) => ({
    answers: `${from} to ${to}${unit === undefined ? '' : ` ${inWords(unit)}`}`,
  }),
  simulate({ from, to, whole }, part) {
    const value = from + (to - from) * part;
    return whole ? Math.round(value) : value;
  },
};
