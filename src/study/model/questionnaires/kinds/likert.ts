import { integerBetween, ValidationError } from 'threepoint/core';
import * as v from 'valibot';
import { words } from '../../phrases/localized-text';
import type { QuestionKind } from '../question-kind';
import { answeredOnScale, checkSteps, ends, endTexts, pointsOn, type SteppedScale } from './scale-kind';

const maxPoints = 101;

const schema = v.strictObject({
  kind: v.literal('likert'),
  /** The first and the last point, both whole numbers. */
  from: integerBetween(-1000, 1000),
  to: integerBetween(-1000, 1000),
  /** The distance of two points; 1 if absent. */
  step: v.exactOptional(integerBetween(1, 1000)),
  /** Texts below the ends of the scale. */
  ends: v.exactOptional(ends),
  /** Labels of every point, the first to the last. */
  labels: v.exactOptional(v.array(words(40), 'expected a list of labels')),
});

/** A scale of points, each of which may have a label. */
export type LikertForm = v.InferOutput<typeof schema>;

declare module '../question-kind' {
  interface AnswerForms {
    likert: LikertForm;
  }
}

const scaleOf = ({ from, to, step = 1 }: LikertForm): SteppedScale => ({ from, to, step });

const endsOf = ({ labels, ends: texts }: LikertForm) => ({
  low: labels?.[0] ?? texts?.low,
  high: labels?.at(-1) ?? texts?.high,
});

export const likertPoints = (form: LikertForm): readonly number[] => pointsOn(scaleOf(form));

export const likert: QuestionKind<LikertForm> = {
  kind: 'likert',
  schema,
  ...answeredOnScale(scaleOf, endsOf),
  check(form, field) {
    checkSteps(scaleOf(form), maxPoints - 1, field);
    const points = likertPoints(form).length;
    if (form.labels && form.labels.length !== points) {
      throw new ValidationError(
        `${field}.labels`,
        `expected ${points}, one for each point, found ${form.labels.length}`,
      );
    }
  },
  texts: (form) => [
    ...endTexts(form.ends),
    ...(form.labels ?? []).map((label, index) => [`labels[${index}]`, label] as const),
  ],
};
