import { identifier, numberBetween, ValidationError } from 'threepoint/core';
import * as v from 'valibot';
import { scaleScore } from './questionnaire-scores';
import { type Answers, isNumeric, type Questionnaire } from './questionnaires';

const limit = 1_000_000;
const measure = v.pipe(
  v.string('expected text'),
  v.regex(/^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$/, 'expected the id of a scale or a question'),
);

/** A stopping rule: the value of a scale or question from which a participant is asked whether to stop. */
export const stoppingRuleSchema = v.strictObject({
  questionnaire: identifier,
  /** The id of a scale, or of a question with a numeric answer. */
  measure,
  atLeast: numberBetween(-limit, limit),
});

export type StoppingRule = v.InferOutput<typeof stoppingRuleSchema>;

/** A stopping rule that was reached, with the value. */
export interface ReachedRule extends StoppingRule {
  readonly value: number;
}

/** Throws a ValidationError if a rule is about something that the study does not ask. */
export function checkStoppingRules(limits: readonly StoppingRule[], asked: readonly Questionnaire[]): void {
  limits.forEach((one, index) => {
    const field = `askToStop[${index}]`;
    const questionnaire = asked.find(({ id }) => id === one.questionnaire);
    if (!questionnaire) throw new ValidationError(`${field}.questionnaire`, `no task asks "${one.questionnaire}"`);
    if (!isNumeric(questionnaire, one.measure)) {
      throw new ValidationError(
        `${field}.measure`,
        `"${one.questionnaire}" has no scale "${one.measure}", and no question of this name that is answered with a number`,
      );
    }
  });
}

/** Returns the first of the rules that these answers reach, or null. */
export function reachedRule(
  limits: readonly StoppingRule[],
  asked: Questionnaire,
  answers: Answers,
): ReachedRule | null {
  for (const one of limits.filter(({ questionnaire }) => questionnaire === asked.id)) {
    const scale = asked.scales.find(({ id }) => id === one.measure);
    const value = scale ? scaleScore(asked, scale, answers) : answers[one.measure];
    if (typeof value === 'number' && value >= one.atLeast) return { ...one, value };
  }
  return null;
}
