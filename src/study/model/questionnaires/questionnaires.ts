import { checked, ValidationError } from 'threepoint/core/validation/validation';
import * as v from 'valibot';
import { missingLanguage, type Words } from '../phrases/words';
import type { AnswerForm, Question, QuestionnaireFile, Scale } from './questionnaire-schema';
import { questionnaireSchema } from './questionnaire-schema';
import archery from './shipped/archery.json' with { type: 'json' };
import ball from './shipped/ball.json' with { type: 'json' };
import nasaTlx from './shipped/nasa-tlx.json' with { type: 'json' };
import nasaTlxRaw from './shipped/nasa-tlx-raw.json' with { type: 'json' };
import ssq from './shipped/ssq.json' with { type: 'json' };
import systemUsability from './shipped/system-usability.json' with { type: 'json' };

/** A questionnaire whose questions all say how they are answered. */
export interface Questionnaire {
  readonly id: string;
  readonly title: Words;
  readonly source?: string;
  readonly questions: readonly Question[];
  readonly scales: readonly Scale[];
}

/** An answer as it is recorded: a number, or a text (what was typed, or the value of the option chosen). */
export type Answer = number | string;

/** Question id to answer, as given: reversed questions are not turned round. */
export type Answers = Readonly<Record<string, Answer>>;

const mostPoints = 101;
const mostSliderSteps = 200;

/** The distance of two answers that a scale tells apart; a slider that says nothing has a hundred. */
export const stepOf = (form: Extract<AnswerForm, { kind: 'likert' | 'slider' }>): number =>
  form.step ?? (form.kind === 'likert' ? 1 : (form.to - form.from) / 100);

/** The number on a scale nearest to a value; ends included. */
export function nearestOn(form: Extract<AnswerForm, { kind: 'likert' | 'slider' }>, value: number): number {
  const step = stepOf(form);
  const steps = Math.min(Math.round((form.to - form.from) / step), Math.max(0, Math.round((value - form.from) / step)));
  return Number((form.from + steps * step).toFixed(6));
}

/** The points of a Likert scale, first to last; everything between the ends of a slider in its steps. */
export function pointsOf(form: Extract<AnswerForm, { kind: 'likert' | 'slider' }>): readonly number[] {
  const steps = Math.round((form.to - form.from) / stepOf(form));
  return Array.from({ length: steps + 1 }, (_, index) => nearestOn(form, form.from + index * stepOf(form)));
}

function refuseForm(form: AnswerForm, field: string): void {
  if (form.kind === 'text') return;
  if (form.kind === 'choice') {
    form.options.forEach(({ value }, index) => {
      const first = form.options.findIndex((option) => option.value === value);
      if (first !== index) {
        throw new ValidationError(`${field}.options[${index}].value`, `"${value}" is the value of option ${first} too`);
      }
    });
    return;
  }
  if (form.to <= form.from)
    throw new ValidationError(`${field}.to`, `expected more than ${form.from}, where it begins`);
  if (form.kind === 'number') return;
  const steps = (form.to - form.from) / stepOf(form);
  if (Math.abs(steps - Math.round(steps)) > 1e-6) {
    throw new ValidationError(
      `${field}.step`,
      `${form.from} to ${form.to} is no whole number of steps of ${form.step}`,
    );
  }
  const most = form.kind === 'likert' ? mostPoints - 1 : mostSliderSteps;
  if (steps > most + 1e-6) throw new ValidationError(`${field}.step`, `expected at most ${most} steps from end to end`);
  if (form.kind === 'likert' && form.labels && form.labels.length !== Math.round(steps) + 1) {
    const points = Math.round(steps) + 1;
    throw new ValidationError(`${field}.labels`, `expected ${points}, one for each point, found ${form.labels.length}`);
  }
}

function refuseScale(scale: Scale, questions: readonly Question[], field: string): void {
  const named = (list: 'questions' | 'choices') =>
    (scale[list] ?? []).forEach((id, index) => {
      const found = questions.find((question) => question.id === id);
      const at = `${field}.${list}[${index}]`;
      if (!found) throw new ValidationError(at, `there is no question "${id}"`);
      const chosen = found.answer.kind === 'choice';
      if (list === 'choices' && !chosen) throw new ValidationError(at, `"${id}" is no choice`);
      if (list === 'questions' && (chosen || found.answer.kind === 'text')) {
        throw new ValidationError(at, `"${id}" is not answered with a number`);
      }
    });
  named('questions');
  named('choices');
  if (scale.method === 'count' && scale.atLeast === undefined)
    throw new ValidationError(`${field}.atLeast`, 'is missing');
  if (scale.method === 'weighted-mean' && !scale.choices) throw new ValidationError(`${field}.choices`, 'is missing');
}

/** A questionnaire with how each question is answered; throws a ValidationError with the field below `field`. */
export function resolvedQuestionnaire(file: QuestionnaireFile, field = ''): Questionnaire {
  const at = (way: string) => (field ? `${field}.${way}` : way);
  if (file.answer) refuseForm(file.answer, at('answer'));
  const questions = file.questions.map((question, index): Question => {
    const way = at(`questions[${index}]`);
    const first = file.questions.findIndex(({ id }) => id === question.id);
    if (first !== index)
      throw new ValidationError(`${way}.id`, `"${question.id}" is the name of question ${first} too`);
    // Answers are kept by name: such a one would be there before anything is answered.
    if (question.id in {})
      throw new ValidationError(`${way}.id`, `"${question.id}" is a name that the program keeps for itself`);
    const answer = question.answer ?? file.answer;
    if (!answer) throw new ValidationError(`${way}.answer`, 'is missing, and the questionnaire says none for all');
    if (question.answer) refuseForm(question.answer, `${way}.answer`);
    if (question.reversed && (answer.kind === 'choice' || answer.kind === 'text')) {
      throw new ValidationError(`${way}.reversed`, `a ${answer.kind} has no other way round`);
    }
    return { ...question, answer };
  });
  const scales = file.scales ?? [];
  scales.forEach((scale, index) => {
    refuseScale(scale, questions, at(`scales[${index}]`));
    if (scales.findIndex(({ id }) => id === scale.id) !== index || questions.some(({ id }) => id === scale.id)) {
      throw new ValidationError(at(`scales[${index}].id`), `"${scale.id}" is the name of another scale or a question`);
    }
  });
  return { id: file.id, title: file.title, ...(file.source && { source: file.source }), questions, scales };
}

/** Every text of a questionnaire that participants read, with its field below `field`. */
function textsOf(
  { title, answer, questions }: QuestionnaireFile,
  field: string,
): readonly (readonly [string, Words])[] {
  const ofForm = (form: AnswerForm | undefined, at: string): readonly (readonly [string, Words])[] => {
    if (!form || form.kind === 'text') return [];
    if (form.kind === 'choice')
      return form.options.map(({ label }, i) => [`${at}.options[${i}].label`, label] as const);
    if (form.kind === 'number') return form.unit === undefined ? [] : [[`${at}.unit`, form.unit]];
    const labels = form.kind === 'likert' ? (form.labels ?? []) : [];
    return [
      ...(form.ends ? [[`${at}.ends.low`, form.ends.low] as const, [`${at}.ends.high`, form.ends.high] as const] : []),
      ...labels.map((label, i) => [`${at}.labels[${i}]`, label] as const),
    ];
  };
  return [
    [`${field}.title`, title],
    ...ofForm(answer, `${field}.answer`),
    ...questions.flatMap((one, i) => [
      [`${field}.questions[${i}].text`, one.text] as const,
      ...ofForm(one.answer, `${field}.questions[${i}].answer`),
    ]),
  ];
}

/** Throws a ValidationError for the first text that one of the languages lacks. */
export function refuseMissingLanguages(file: QuestionnaireFile, languages: readonly string[], field: string): void {
  for (const [at, text] of textsOf(file, field)) {
    const missing = missingLanguage(text, languages);
    if (missing !== null)
      throw new ValidationError(`${at}.${missing}`, 'is missing, and the study is in this language too');
  }
}

const shipped = (file: unknown): readonly [string, Questionnaire] => {
  const questionnaire = resolvedQuestionnaire(checked(questionnaireSchema, file));
  return [questionnaire.id, questionnaire];
};

/** The questionnaires that come with the program, by id: a plan names them. */
export const shippedQuestionnaires: Readonly<Record<string, Questionnaire>> = Object.fromEntries(
  [archery, ball, nasaTlx, nasaTlxRaw, ssq, systemUsability].map(shipped),
);

/** The questionnaire of this id: the plan's own, or one of the shipped; null: there is none. */
export function questionnaireNamed(
  plan: { readonly questionnaires?: readonly QuestionnaireFile[] },
  id: string,
): Questionnaire | null {
  const own = plan.questionnaires?.find((questionnaire) => questionnaire.id === id);
  if (own) return resolvedQuestionnaire(own);
  return Object.hasOwn(shippedQuestionnaires, id) ? (shippedQuestionnaires[id] as Questionnaire) : null;
}

/** Whether this is one of its scales, or a question that is answered with a number. */
export const isNumeric = ({ questions, scales }: Questionnaire, id: string): boolean =>
  scales.some((scale) => scale.id === id) ||
  questions.some(({ id: own, answer }) => own === id && answer.kind !== 'text' && answer.kind !== 'choice');

/** What an answer to a form must be, in words: "expected a whole number from 1 to 5". */
export function expectedAnswer(form: AnswerForm): string {
  switch (form.kind) {
    case 'likert':
    case 'slider': {
      const step = stepOf(form);
      if (step === 1) return `expected a whole number from ${form.from} to ${form.to}`;
      return `expected a number from ${form.from} to ${form.to} in steps of ${Number(step.toFixed(6))}`;
    }
    case 'number':
      return `expected a ${form.whole ? 'whole ' : ''}number from ${form.from} to ${form.to}`;
    case 'choice':
      return `expected one of ${form.options.map(({ value }) => value).join(', ')}`;
    case 'text':
      return `expected text of at most ${form.maxLength} characters`;
  }
}

/** Whether this may be the answer to a question of this form. */
export function isAnswer(form: AnswerForm, value: unknown): value is Answer {
  switch (form.kind) {
    case 'likert':
    case 'slider':
      return typeof value === 'number' && Number.isFinite(value) && Math.abs(nearestOn(form, value) - value) < 1e-6;
    case 'number':
      return (
        typeof value === 'number' &&
        value >= form.from &&
        value <= form.to &&
        (form.whole !== true || Number.isInteger(value))
      );
    case 'choice':
      return form.options.some((option) => option.value === value);
    case 'text':
      return typeof value === 'string' && value.trim() !== '' && value.length <= form.maxLength;
  }
}

/** What was typed as an answer; null: it is none, or not yet. */
export function typedAnswer(form: AnswerForm, typed: string): Answer | null {
  const text = typed.trim();
  if (text === '') return null;
  const value = form.kind === 'number' ? Number(text.replace('−', '-').replace(',', '.')) : text;
  return isAnswer(form, value) ? value : null;
}

const loose = v.record(v.string(), v.union([v.number(), v.string()], 'expected a number or a text'));

/** The answers as given so far, some perhaps missing; throws for a question that is not asked or a value off its scale. */
export function checkedDraft(questionnaire: Questionnaire, value: unknown): Answers {
  const answers = checked(loose, value);
  for (const [id, answer] of Object.entries(answers)) {
    const asked = questionnaire.questions.find((question) => question.id === id);
    if (!asked) throw new ValidationError(id, `the questionnaire "${questionnaire.id}" does not ask this`);
    if (!isAnswer(asked.answer, answer)) throw new ValidationError(id, expectedAnswer(asked.answer));
  }
  return answers;
}

/** The ids of the questions that still need an answer, in the order asked. */
export const unanswered = ({ questions }: Pick<Questionnaire, 'questions'>, answers: Answers): readonly string[] =>
  questions.filter(({ id, optional }) => !optional && answers[id] === undefined).map(({ id }) => id);

/** Complete answers; throws for what `checkedDraft` refuses and for the first question left out. */
export function checkedAnswers(questionnaire: Questionnaire, value: unknown): Answers {
  const answers = checkedDraft(questionnaire, value);
  const [missing] = unanswered(questionnaire, answers);
  if (missing) throw new ValidationError(missing, 'this question has no answer');
  return answers;
}
