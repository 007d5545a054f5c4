import type { Answer } from '../model/questionnaires/question-kind';
import { questionKind } from '../model/questionnaires/question-kinds';
import type { Question } from '../model/questionnaires/questionnaire-schema';
import type { Answers, Questionnaire } from '../model/questionnaires/questionnaires';
import type { RandomSource } from './random-source';

// A simulated answer is a latent value [points of a scale from 1 to 5, stretched to the question's scale], rounded to
// the scale. It is the sum of a mean, the person's deviation, effects and noise. These parameters are stated, not
// fitted to people.
const meanAnswer = 3.4;
/** The standard deviation between persons, constant over the answers of each, and that of one answer. */
const personDeviation = 0.5;
const answerDeviation = 0.8;

/** Draws the constant deviation of a person. */
export const drawPerson = (random: RandomSource): number => personDeviation * random.normal();

/** Returns a latent value as an answer: its position between the ends of the scale, reversed if the question is. */
function answerAt({ answer: form, reversed }: Question, latent: number, random: RandomSource): Answer {
  const part = Math.min(1, Math.max(0, (latent - 1) / 4));
  return questionKind(form).simulate(form, reversed ? 1 - part : part, () => random.uniform());
}

/** Draws all answers to a questionnaire of a person with this deviation, under conditions with this effect. */
export const drawAnswers = (
  { questions }: Questionnaire,
  person: number,
  effect: number,
  random: RandomSource,
): Answers =>
  Object.fromEntries(
    questions.map((question) => {
      const latent = meanAnswer + person + effect + answerDeviation * random.normal();
      return [question.id, answerAt(question, latent, random)];
    }),
  );
