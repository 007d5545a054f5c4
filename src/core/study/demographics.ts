import * as v from 'valibot';
import { checked, integerBetween, text } from './validation';

export type DemographicField =
  | {
      readonly id: keyof Demographics;
      readonly label: string;
      readonly kind: 'choice';
      readonly options: readonly { readonly value: string; readonly label: string }[];
    }
  | {
      readonly id: keyof Demographics;
      readonly label: string;
      readonly kind: 'age';
      readonly min: number;
      readonly max: number;
    }
  | { readonly id: keyof Demographics; readonly label: string; readonly kind: 'text'; readonly maxLength: number };

const genders = ['woman', 'man', 'non-binary', 'other', 'not-said'] as const;
const experiences = ['none', 'once-or-twice', 'several-times', 'monthly', 'weekly'] as const;
const hands = ['right', 'left', 'both'] as const;
const visions = ['normal', 'corrected', 'impaired'] as const;
const ages = { min: 16, max: 120 };
const longest = { major: 80, systems: 120 };

const demographicsSchema = v.object({
  gender: v.picklist(genders, `expected one of ${genders.join(', ')}`),
  /** Years. */
  age: integerBetween(ages.min, ages.max),
  /** Field of study or work. */
  major: text(longest.major),
  vrExperience: v.picklist(experiences, `expected one of ${experiences.join(', ')}`),
  /** Which systems were used before; may be empty. */
  vrSystems: v.pipe(
    v.string('expected text'),
    v.trim(),
    v.maxLength(longest.systems, `expected at most ${longest.systems} characters`),
  ),
  handedness: v.picklist(hands, `expected one of ${hands.join(', ')}`),
  vision: v.picklist(visions, `expected one of ${visions.join(', ')}`),
});

/** What the paper asked of its participants before they played, and which hand they prefer. */
export type Demographics = v.InferOutput<typeof demographicsSchema>;

/** Throws a ValidationError that names the field. */
export const checkedDemographics = (value: unknown): Demographics => checked(demographicsSchema, value);

/** The form, in the order asked. Everything but the systems used must be answered; gender need not be told. */
export const demographicFields: readonly DemographicField[] = [
  {
    id: 'gender',
    label: 'Gender',
    kind: 'choice',
    options: [
      { value: 'woman', label: 'Woman' },
      { value: 'man', label: 'Man' },
      { value: 'non-binary', label: 'Non-binary' },
      { value: 'other', label: 'Another' },
      { value: 'not-said', label: 'I prefer not to say' },
    ],
  },
  { id: 'age', label: 'Age [years]', kind: 'age', ...ages },
  { id: 'major', label: 'Field of study or work', kind: 'text', maxLength: longest.major },
  {
    id: 'vrExperience',
    label: 'How often have you used virtual reality?',
    kind: 'choice',
    options: [
      { value: 'none', label: 'Never' },
      { value: 'once-or-twice', label: 'Once or twice' },
      { value: 'several-times', label: 'Several times' },
      { value: 'monthly', label: 'Every month' },
      { value: 'weekly', label: 'Every week' },
    ],
  },
  { id: 'vrSystems', label: 'Which systems? (may stay empty)', kind: 'text', maxLength: longest.systems },
  {
    id: 'handedness',
    label: 'Which hand do you prefer?',
    kind: 'choice',
    options: [
      { value: 'right', label: 'Right' },
      { value: 'left', label: 'Left' },
      { value: 'both', label: 'Both alike' },
    ],
  },
  {
    id: 'vision',
    label: 'How do you see?',
    kind: 'choice',
    options: [
      { value: 'normal', label: 'Well without correction' },
      { value: 'corrected', label: 'Well with glasses or lenses' },
      { value: 'impaired', label: 'Impaired, also in the headset' },
    ],
  },
];
