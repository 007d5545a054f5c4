import { checked, ValidationError } from 'threepoint/core';
import { games } from 'threepoint-games/all';
import * as v from 'valibot';
import { type LocalizedText, missingLanguage } from '../phrases/localized-text';
import type { Answer, AnswerForm } from './question-kind';
import { questionKind } from './question-kinds';
import type { Question, QuestionnaireFile, Scale } from './questionnaire-schema';
import { questionnaireSchema } from './questionnaire-schema';
import nasaTlx from './shipped/nasa-tlx.json' with { type: 'json' };
import nasaTlxRaw from './shipped/nasa-tlx-raw.json' with { type: 'json' };
import ssq from './shipped/ssq.json' with { type: 'json' };
import systemUsability from './shipped/system-usability.json' with { type: 'json' };

/** A questionnaire with a form of the answer to every question. */
export interface Questionnaire {
  readonly id: string;
  readonly title: LocalizedText;
  readonly source?: string;
  readonly questions: readonly Question[];
  readonly scales: readonly Scale[];
}

/** The answers by the id of the question, as given: reversed questions are not converted. */
export type Answers = Readonly<Record<string, Answer>>;

function rejectScale(scale: Scale, questions: readonly Question[], field: string): void {
  const named = (list: 'questions' | 'choices') =>
    (scale[list] ?? []).forEach((id, index) => {
      const found = questions.find((question) => question.id === id);
      const at = `${field}.${list}[${index}]`;
      if (!found) throw new ValidationError(at, `there is no question "${id}"`);
      const kind = questionKind(found.answer);
      if (list === 'choices' && kind.options(found.answer) === null) {
        throw new ValidationError(at, `"${id}" is not a choice`);
      }
      if (list === 'questions' && kind.range(found.answer) === null) {
        throw new ValidationError(at, `"${id}" is not answered with a number`);
      }
    });
  named('questions');
  named('choices');
  if (scale.method === 'count' && scale.atLeast === undefined)
    throw new ValidationError(`${field}.atLeast`, 'is missing');
  if (scale.method === 'weighted-mean' && !scale.choices) throw new ValidationError(`${field}.choices`, 'is missing');
}

/**
 * Returns a questionnaire with the form of every question's answer; throws a ValidationError with the field below
 * `field`.
 */
export function resolvedQuestionnaire(file: QuestionnaireFile, field = ''): Questionnaire {
  const at = (way: string) => (field ? `${field}.${way}` : way);
  if (file.answer) questionKind(file.answer).check?.(file.answer, at('answer'));
  const questions = file.questions.map((question, index): Question => {
    const way = at(`questions[${index}]`);
    const first = file.questions.findIndex(({ id }) => id === question.id);
    if (first !== index)
      throw new ValidationError(`${way}.id`, `"${question.id}" is the name of question ${first} too`);
    // Answers are properties of an object, so an id must not be one of its prototype.
    if (question.id in {}) throw new ValidationError(`${way}.id`, `"${question.id}" is a reserved name`);
    const answer = question.answer ?? file.answer;
    if (!answer)
      throw new ValidationError(`${way}.answer`, 'is missing, and the questionnaire has none for all questions');
    if (question.answer) questionKind(question.answer).check?.(question.answer, `${way}.answer`);
    if (question.reversed && questionKind(answer).range(answer) === null) {
      throw new ValidationError(`${way}.reversed`, `answers of the kind "${answer.kind}" cannot be reversed`);
    }
    return { ...question, answer };
  });
  const scales = file.scales ?? [];
  scales.forEach((scale, index) => {
    rejectScale(scale, questions, at(`scales[${index}]`));
    if (scales.findIndex(({ id }) => id === scale.id) !== index || questions.some(({ id }) => id === scale.id)) {
      throw new ValidationError(at(`scales[${index}].id`), `"${scale.id}" is the name of another scale or a question`);
    }
  });
  return { id: file.id, title: file.title, ...(file.source && { source: file.source }), questions, scales };
}

/** Returns every text of a questionnaire that participants read, with its field below `field`. */
function textsOf(
  { title, answer, questions }: QuestionnaireFile,
  field: string,
): readonly (readonly [string, LocalizedText])[] {
  const formInWords = (form: AnswerForm | undefined, at: string) =>
    form === undefined
      ? []
      : questionKind(form)
          .texts(form)
          .map(([path, text]) => [`${at}.${path}`, text] as const);
  return [
    [`${field}.title`, title],
    ...formInWords(answer, `${field}.answer`),
    ...questions.flatMap((one, i) => [
      [`${field}.questions[${i}].text`, one.text] as const,
      ...formInWords(one.answer, `${field}.questions[${i}].answer`),
    ]),
  ];
}

/** Throws a ValidationError for the first text that one of the languages lacks. */
export function rejectMissingLanguages(file: QuestionnaireFile, languages: readonly string[], field: string): void {
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

/** The questionnaires of the games and of this package by id; plans use them by name. */
export const shippedQuestionnaires: Readonly<Record<string, Questionnaire>> = Object.fromEntries(
  [
    ...Object.values(games).flatMap(({ questionnaire }) => questionnaire ?? []),
    ...[nasaTlx, nasaTlxRaw, ssq, systemUsability],
  ].map(shipped),
);

/** Returns the questionnaire of this id, of the plan or shipped, or null. */
export function questionnaireNamed(
  plan: { readonly questionnaires?: readonly QuestionnaireFile[] },
  id: string,
): Questionnaire | null {
  const own = plan.questionnaires?.find((questionnaire) => questionnaire.id === id);
  if (own) return resolvedQuestionnaire(own);
  return Object.hasOwn(shippedQuestionnaires, id) ? (shippedQuestionnaires[id] as Questionnaire) : null;
}

/** Returns whether this is a scale or a question with a numeric answer. */
export const isNumeric = ({ questions, scales }: Questionnaire, id: string): boolean =>
  scales.some((scale) => scale.id === id) ||
  questions.some(({ id: own, answer }) => own === id && questionKind(answer).range(answer) !== null);

/** Returns the answer that a participant typed, or null if it is not an answer (yet). */
export function typedAnswer(form: AnswerForm, typed: string): Answer | null {
  const text = typed.trim();
  const kind = questionKind(form);
  if (text === '' || !kind.parse) return null;
  const parsed = v.safeParse(kind.answer(form), kind.parse(text));
  return parsed.success ? parsed.output : null;
}

const loose = v.record(v.string(), v.union([v.number(), v.string()], 'expected a number or a text'));

/** Returns the answer to a question; throws for an unknown question and an invalid value. */
export function checkedAnswer({ id, questions }: Questionnaire, question: string, answer: unknown): Answer {
  const asked = questions.find((one) => one.id === question);
  if (!asked) throw new ValidationError(question, `the questionnaire "${id}" does not ask this`);
  const given = v.safeParse(questionKind(asked.answer).answer(asked.answer), answer);
  if (!given.success) throw new ValidationError(question, given.issues[0].message);
  return given.output;
}

/** Returns answers that may be incomplete; throws as `checkedAnswer` does. */
export function checkedDraft(questionnaire: Questionnaire, value: unknown): Answers {
  const answers = checked(loose, value);
  for (const [question, answer] of Object.entries(answers)) checkedAnswer(questionnaire, question, answer);
  return answers;
}

/** Returns the ids of the questions that still need an answer, in the order asked. */
export const unanswered = ({ questions }: Pick<Questionnaire, 'questions'>, answers: Answers): readonly string[] =>
  questions.filter(({ id, optional }) => !optional && answers[id] === undefined).map(({ id }) => id);

/** Returns checked answers if they are complete; throws for the first missing one. */
export function completeAnswers(questionnaire: Questionnaire, answers: Answers): Answers {
  const [missing] = unanswered(questionnaire, answers);
  if (missing) throw new ValidationError(missing, 'this question has no answer');
  return answers;
}

/** Returns complete answers; throws as `checkedDraft` and `completeAnswers` do. */
export const checkedAnswers = (questionnaire: Questionnaire, value: unknown): Answers =>
  completeAnswers(questionnaire, checkedDraft(questionnaire, value));
