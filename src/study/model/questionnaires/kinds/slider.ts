import { numberBetween } from 'threepoint/core';
import * as v from 'valibot';
import type { QuestionKind } from '../question-kind';
import { limit, limitedNumber } from './limits';
import { answeredOnScale, checkSteps, ends, endTexts, pointsOn, type SteppedScale } from './scale-kind';

const maxSteps = 200;

const schema = v.strictObject({
  kind: v.literal('slider'),
  from: limitedNumber,
  to: limitedNumber,
  step: v.exactOptional(numberBetween(0.001, limit)),
  ends,
});

/** A visual analogue scale: a line without points. */
export type SliderForm = v.InferOutput<typeof schema>;

declare module '../question-kind' {
  interface AnswerForms {
    slider: SliderForm;
  }
}

const usualSteps = 100;
const scaleOf = ({ from, to, step = (to - from) / usualSteps }: SliderForm): SteppedScale => ({ from, to, step });

/** Returns every value that the line distinguishes in ascending order. */
export const sliderValues = (form: SliderForm): readonly number[] => pointsOn(scaleOf(form));

export const slider: QuestionKind<SliderForm> = {
  kind: 'slider',
  schema,
  ...answeredOnScale(scaleOf, (form) => form.ends),
  check: (form, field) => checkSteps(scaleOf(form), maxSteps, field),
  texts: (form) => endTexts(form.ends),
};
