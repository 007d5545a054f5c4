import { checked, integerBetween, text } from 'threepoint/core';
import * as v from 'valibot';
import type { PlainKey } from '../phrases/phrases';

/** A question about participants; its text is in the phrases of the page. */
export type DemographicField = { readonly id: keyof Demographics; readonly phrase: PlainKey } & (
  | {
      readonly kind: 'choice';
      readonly options: readonly { readonly value: string; readonly phrase: PlainKey }[];
    }
  | { readonly kind: 'age'; readonly min: number; readonly max: number }
  | { readonly kind: 'text'; readonly maxLength: number }
);

const genders = ['woman', 'man', 'non-binary', 'other', 'not-said'] as const;
const experiences = ['none', 'once-or-twice', 'several-times', 'monthly', 'weekly'] as const;
const hands = ['right', 'left', 'both'] as const;
const visions = ['normal', 'corrected', 'impaired'] as const;
const ages = { min: 16, max: 120 };
const longest = { major: 80, systems: 120 };

export const demographicsSchema = v.object({
  gender: v.picklist(genders, `expected one of ${genders.join(', ')}`),
  /** Years. */
  age: integerBetween(ages.min, ages.max),
  /** Field of study or work. */
  major: text(longest.major),
  vrExperience: v.picklist(experiences, `expected one of ${experiences.join(', ')}`),
  /** The systems that were used before; may be empty. */
  vrSystems: v.pipe(
    v.string('expected text'),
    v.trim(),
    v.maxLength(longest.systems, `expected at most ${longest.systems} characters`),
  ),
  handedness: v.picklist(hands, `expected one of ${hands.join(', ')}`),
  vision: v.picklist(visions, `expected one of ${visions.join(', ')}`),
});

/** The answers to the questions that the paper asked before play, and the preferred hand. */
export type Demographics = v.InferOutput<typeof demographicsSchema>;

/** Returns valid demographics; throws a ValidationError that names the field. */
export const checkedDemographics = (value: unknown): Demographics => checked(demographicsSchema, value);

/** Returns a choice with the phrase of every value. */
const choiceOf = <Id extends 'gender' | 'vrExperience' | 'handedness' | 'vision'>(
  id: Id,
  values: readonly Demographics[Id][],
): DemographicField => ({
  id,
  phrase: `about.${id}`,
  kind: 'choice',
  options: values.map((value) => ({ value, phrase: `about.${id}.${value}` as PlainKey })),
});

/** The fields of the form in order. Everything but the systems must be answered; gender has an option not to say. */
export const demographicFields: readonly DemographicField[] = [
  choiceOf('gender', genders),
  { id: 'age', phrase: 'about.age', kind: 'age', ...ages },
  { id: 'major', phrase: 'about.major', kind: 'text', maxLength: longest.major },
  choiceOf('vrExperience', experiences),
  { id: 'vrSystems', phrase: 'about.vrSystems', kind: 'text', maxLength: longest.systems },
  choiceOf('handedness', hands),
  choiceOf('vision', visions),
];
