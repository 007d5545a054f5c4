import * as v from 'valibot';
import { checked, integerBetween, numberBetween, text, ValidationError } from './validation';

/** One question of a questionnaire, answered on the scale. */
export interface Question {
  readonly id: string;
  readonly text: string;
  /** What it asks about, in a word or two: headings of charts and tables. */
  readonly about: string;
}

export interface Questionnaire {
  readonly id: QuestionnaireId;
  readonly title: string;
  /** All of them must be answered. */
  readonly questions: readonly Question[];
}

/** Five points; the paper names the ends (very poor, excellent), the three between are ours. */
export const scale = [
  { value: 1, label: 'Very poor' },
  { value: 2, label: 'Poor' },
  { value: 3, label: 'Fair' },
  { value: 4, label: 'Good' },
  { value: 5, label: 'Excellent' },
] as const;

export const questionnaireIds = ['archery', 'ball'] as const;
export type QuestionnaireId = (typeof questionnaireIds)[number];

/** Tables 7 and 8 of the paper, word for word. In Q5 it reads a high answer as little delay. */
export const questionnaires: Readonly<Record<QuestionnaireId, Questionnaire>> = {
  archery: {
    id: 'archery',
    title: 'Archery',
    questions: [
      {
        id: 'Q1',
        about: 'presence',
        text: 'How strongly did you feel a sense of presence while using this method?',
      },
      {
        id: 'Q2',
        about: 'embodiment',
        text: 'How strongly did you feel a sense of embodiment while using this method?',
      },
      {
        id: 'Q3',
        about: 'moving around',
        text: 'How compelling was your sense of moving around inside the virtual environment?',
      },
      { id: 'Q4', about: 'accuracy', text: 'How accurate was the environment for actions you are in?' },
      {
        id: 'Q5',
        about: 'delay',
        text: 'To what extent did you observe a delay between actions and the expected outcomes?',
      },
      { id: 'Q6', about: 'naturalness', text: 'How natural did your interactions with the environment seem?' },
      {
        id: 'Q7',
        about: 'preference',
        text: 'Do you prefer this method overall (for a single-user virtual game)?',
      },
    ],
  },
  ball: {
    id: 'ball',
    title: 'Ball game',
    questions: [
      {
        id: 'Q8',
        about: 'presence',
        text: 'How strongly did you feel a sense of presence while using this method?',
      },
      {
        id: 'Q9',
        about: 'ownership',
        text: 'How strongly did you feel like your virtual body was your own while using this method?',
      },
      {
        id: 'Q10',
        about: 'prediction',
        text: 'How well were you able to predict the outcome of your actions in the virtual environment?',
      },
      {
        id: 'Q11',
        about: 'manipulation',
        text: 'How easily were you able to move and manipulate objects in the virtual environment?',
      },
      {
        id: 'Q12',
        about: 'preference',
        text: 'Would you say you prefer this method over others for a multi-user virtual game?',
      },
    ],
  },
};

/** Question id to an answer from 1 to 5. */
export type Answers = Readonly<Record<string, number>>;

/** The answers as given so far, some perhaps missing; throws for a question that is not asked or a value off the scale. */
export function checkedDraft(questionnaire: Questionnaire, value: unknown): Answers {
  const answers = checked(v.record(v.string(), integerBetween(1, scale.length)), value);
  for (const id of Object.keys(answers)) {
    if (!questionnaire.questions.some((question) => question.id === id)) {
      throw new ValidationError(id, `the questionnaire "${questionnaire.id}" does not ask this`);
    }
  }
  return answers;
}

/** The ids of the questions without an answer, in the order asked. */
export const unanswered = (questionnaire: Questionnaire, answers: Answers): readonly string[] =>
  questionnaire.questions.map(({ id }) => id).filter((id) => answers[id] === undefined);

/** Complete answers; throws for what `checkedDraft` refuses and for the first question left out. */
export function checkedAnswers(questionnaire: Questionnaire, value: unknown): Answers {
  const answers = checkedDraft(questionnaire, value);
  const [missing] = unanswered(questionnaire, answers);
  if (missing) throw new ValidationError(missing, 'this question has no answer');
  return answers;
}

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

const consentSchema = v.object({
  /** Of the text that was shown. */
  version: text(40),
  given: v.literal(true, 'nothing is recorded without consent'),
  /** Whether tracked frames may be kept as well. */
  motion: v.boolean('expected true or false'),
  /** Seconds since 1970, on the participant's device. */
  at: numberBetween(0, 1e11),
});

/** Consent to a text of a version; there is no record of a refusal, because then nothing is recorded. */
export type Consent = v.InferOutput<typeof consentSchema>;

/** Throws a ValidationError that names the field, also where the version is not the one of the plan. */
export function checkedConsent(value: unknown, version: string): Consent {
  const consent = checked(consentSchema, value);
  if (consent.version !== version) {
    throw new ValidationError(
      'version',
      `consent was given to text ${consent.version}, but the study shows ${version}`,
    );
  }
  return consent;
}
