import type { Answer } from '../model/questionnaires/question-kind';
import { questionKind } from '../model/questionnaires/question-kinds';
import type { Question } from '../model/questionnaires/questionnaire-schema';
import type { Answers, Questionnaire } from '../model/questionnaires/questionnaires';
import type { RandomSource } from './random-source';

/**
 * The model of simulated answers. An answer is a latent value [points of a scale from 1 to 5, stretched to the
 * question's scale], rounded to the scale. It is the sum of effects of person, question, condition and order, and of
 * noise. The parameters are stated, not fitted to people.
 */
export interface AnswerModel {
  /** The latent value without effects, per question; others have `elsewhere`. */
  readonly base: Readonly<Record<string, number>>;
  readonly elsewhere: number;
  /** The standard deviation between persons, constant over the answers of each. */
  readonly personDeviation: number;
  /** The standard deviation of one answer. */
  readonly answerDeviation: number;
  /**
   * The effect of a condition or a cohort on a question: effects[its id][question]; "*" stands for all other questions.
   */
  readonly effects: Readonly<Record<string, Readonly<Record<string, number>>>>;
  /** The effect of the second and later blocks: practice or fatigue. */
  readonly orderEffect: number;
}

/** The model without differences between conditions. */
export const nullAnswerModel: AnswerModel = {
  base: {},
  elsewhere: 3.4,
  personDeviation: 0.5,
  answerDeviation: 0.8,
  effects: {},
  orderEffect: 0,
};

/** Returns the model with this effect on all questions, by the id of a condition or a cohort. */
export const answerModelWith = (effects: Readonly<Record<string, number>>): AnswerModel => ({
  ...nullAnswerModel,
  effects: Object.fromEntries(Object.entries(effects).map(([id, effect]) => [id, { '*': effect }])),
});

/** Draws the constant deviation of a person. */
export const drawPerson = (model: AnswerModel, random: RandomSource): number => model.personDeviation * random.normal();

/** Returns a latent value as an answer: its position between the ends of the scale, reversed if the question is. */
function answerAt({ answer: form, reversed }: Question, latent: number, random: RandomSource): Answer {
  const part = Math.min(1, Math.max(0, (latent - 1) / 4));
  return questionKind(form).simulate(form, reversed ? 1 - part : part, () => random.uniform());
}

/** The person and the circumstances of answers; `cohort` null: the plan has none. */
export interface Answering {
  readonly person: number;
  readonly condition: string;
  readonly cohort: string | null;
  readonly block: number;
}

/** Draws all answers to a questionnaire. */
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
      const latent = (model.base[id] ?? model.elsewhere) + person + effectOn(id) + (block > 1 ? model.orderEffect : 0);
      return [id, answerAt(question, latent + model.answerDeviation * random.normal(), random)];
    }),
  );
}
