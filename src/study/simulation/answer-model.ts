import type { Answer } from '../model/questionnaires/question-kind';
import { questionKind } from '../model/questionnaires/question-kinds';
import type { Question } from '../model/questionnaires/questionnaire-schema';
import type { Answers, Questionnaire } from '../model/questionnaires/questionnaires';
import type { RandomSource } from './random-source';

/**
 * How a simulated participant answers: a leaning [points of a scale from 1 to 5, stretched to the question's own], the person's own, the question's, the condition's, the place's
 * in the order, and chance, rounded to the scale. Stated, not fitted: no person's answers are imitated.
 */
export interface AnswerModel {
  /** Where answers lie without any effect, per question; others: `elsewhere`. */
  readonly base: Readonly<Record<string, number>>;
  readonly elsewhere: number;
  /** Standard deviation between persons, alike in all of their answers. */
  readonly personDeviation: number;
  /** Standard deviation of one answer about its leaning. */
  readonly answerDeviation: number;
  /** Added under a condition, or in a cohort, to a question: effects[its id][question]; "*" is every question not named. */
  readonly effects: Readonly<Record<string, Readonly<Record<string, number>>>>;
  /** Added in the second and later blocks: practice, or weariness. */
  readonly orderEffect: number;
}

/** No condition differs from another. */
export const nullAnswerModel: AnswerModel = {
  base: {},
  elsewhere: 3.4,
  personDeviation: 0.5,
  answerDeviation: 0.8,
  effects: {},
  orderEffect: 0,
};

/** All questions better by so many points, by the id of a condition or a cohort. */
export const answerModelWith = (effects: Readonly<Record<string, number>>): AnswerModel => ({
  ...nullAnswerModel,
  effects: Object.fromEntries(Object.entries(effects).map(([id, effect]) => [id, { '*': effect }])),
});

/** How this person leans, drawn once. */
export const drawPerson = (model: AnswerModel, random: RandomSource): number => model.personDeviation * random.normal();

/** What a leaning is as an answer to a question: on scales and numbers its place between the ends, turned round where these are. */
function answerAt({ answer: form, reversed }: Question, leaning: number, random: RandomSource): Answer {
  const part = Math.min(1, Math.max(0, (leaning - 1) / 4));
  return questionKind(form).simulate(form, reversed ? 1 - part : part, () => random.uniform());
}

/** Who answers, and in which circumstances; `cohort` null: the plan has none. */
export interface Answering {
  readonly person: number;
  readonly condition: string;
  readonly cohort: string | null;
  readonly block: number;
}

/** All answers of a questionnaire. */
export function drawAnswers(
  model: AnswerModel,
  questionnaire: Questionnaire,
  { person, condition, cohort, block }: Answering,
  random: RandomSource,
): Answers {
  const effectOn = (question: string) =>
    [condition, cohort].reduce((sum, id) => {
      const effects = id === null ? undefined : model.effects[id];
      return sum + (effects?.[question] ?? effects?.['*'] ?? 0);
    }, 0);
  return Object.fromEntries(
    questionnaire.questions.map((question) => {
      const { id } = question;
      const leaning = (model.base[id] ?? model.elsewhere) + person + effectOn(id) + (block > 1 ? model.orderEffect : 0);
      return [id, answerAt(question, leaning + model.answerDeviation * random.normal(), random)];
    }),
  );
}
