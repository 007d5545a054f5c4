import { ValidationError } from 'threepoint/core';
import * as v from 'valibot';
import { type LocalizedText, words } from '../../phrases/localized-text';

/** Numbers at equal distances from one end to the other. */
export interface SteppedScale {
  readonly from: number;
  readonly to: number;
  readonly step: number;
}

/** Returns the number of steps from end to end, which is whole for a valid scale. */
const stepsOf = ({ from, to, step }: SteppedScale): number => (to - from) / step;

/** Returns the number on a scale that is nearest to a value, ends included. */
function nearestOn(scale: SteppedScale, value: number): number {
  const { from, step } = scale;
  const steps = Math.min(Math.round(stepsOf(scale)), Math.max(0, Math.round((value - from) / step)));
  return Number((from + steps * step).toFixed(6));
}

/** Returns every number on a scale in ascending order. */
export const pointsOn = (scale: SteppedScale): readonly number[] =>
  Array.from({ length: Math.round(stepsOf(scale)) + 1 }, (_, index) =>
    nearestOn(scale, scale.from + index * scale.step),
  );

/** The schema of the texts below the ends of a scale. */
export const ends = v.strictObject({ low: words(60), high: words(60) });

export type Ends = v.InferOutput<typeof ends>;

/** Throws a ValidationError if the ends of a range are in the wrong order. */
export function checkRange({ from, to }: Pick<SteppedScale, 'from' | 'to'>, field: string): void {
  if (to <= from) throw new ValidationError(`${field}.to`, `expected more than ${from}, the lower end`);
}

/** Throws a ValidationError unless a whole number of steps, `most` at most, leads from end to end. */
export function checkSteps(scale: SteppedScale, most: number, field: string): void {
  checkRange(scale, field);
  const steps = stepsOf(scale);
  if (Math.abs(steps - Math.round(steps)) > 1e-6) {
    const { from, to, step } = scale;
    throw new ValidationError(`${field}.step`, `${from} to ${to} is not a whole number of steps of ${step}`);
  }
  if (steps > most + 1e-6) throw new ValidationError(`${field}.step`, `expected at most ${most} steps from end to end`);
}

const numberOn = (scale: SteppedScale) => {
  const { from, to, step } = scale;
  return v.custom<number>(
    (value) => typeof value === 'number' && Number.isFinite(value) && Math.abs(nearestOn(scale, value) - value) < 1e-6,
    step === 1
      ? `expected a whole number from ${from} to ${to}`
      : `expected a number from ${from} to ${to} in steps of ${Number(step.toFixed(6))}`,
  );
};

/** Returns the texts below the ends with their paths. */
export const endTexts = (texts: Ends | undefined): readonly (readonly [string, LocalizedText])[] =>
  texts
    ? [
        ['ends.low', texts.low],
        ['ends.high', texts.high],
      ]
    : [];

type EndLabels = { readonly low?: LocalizedText | undefined; readonly high?: LocalizedText | undefined };

/** Describes a scale in words: "1 Very poor to 5 Excellent". */
function scaleInWords(
  { from, to, step }: SteppedScale,
  { low, high }: EndLabels,
  inWords: (text: LocalizedText) => string,
): string {
  const end = (value: number, label: LocalizedText | undefined) =>
    label === undefined ? `${value}` : `${value} ${inWords(label)}`;
  return `${end(from, low)} to ${end(to, high)}${step === 1 ? '' : `, in steps of ${step}`}`;
}

/** Returns the part that kinds of questions share whose answers are the numbers on a scale. */
export const answeredOnScale = <Form extends Omit<SteppedScale, 'step'>>(
  scaleOf: (form: Form) => SteppedScale,
  ends: (form: Form) => EndLabels,
) => ({
  answer: (form: Form) => numberOn(scaleOf(form)),
  range: ({ from, to }: Form) => [from, to] as const,
  options: () => null,
  ends,
  columns: (form: Form, inWords: (text: LocalizedText) => string) => ({
    answers: scaleInWords(scaleOf(form), ends(form), inWords),
  }),
  simulate: (form: Form, part: number) => nearestOn(scaleOf(form), form.from + (form.to - form.from) * part),
});
