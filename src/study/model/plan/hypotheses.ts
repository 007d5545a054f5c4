import { identifier, numberBetween, text, ValidationError } from 'threepoint/core';
import * as v from 'valibot';
import { code } from '../questionnaires/kinds/limits';

/** The schema of a hypothesis about two conditions, whose measures are tested as planned. */
export const hypothesisSchema = v.strictObject({
  /** The name in tables of results: "H1". */
  id: code,
  text: text(300),
  conditions: v.strictTuple([identifier, identifier], 'expected the ids of two conditions'),
  /** The measures that decide: "archery/archery/Q6", "ball/score". */
  measures: v.pipe(
    v.array(text(200), 'expected a list of measures'),
    v.minLength(1, 'expected at least one measure'),
    v.maxLength(40, 'expected at most forty measures'),
  ),
  /**
   * The largest mean difference that counts as none, in the unit of the measures. With it the hypothesis claims that
   * the conditions are equivalent, which two one-sided tests decide; without it, that they differ.
   */
  margin: v.exactOptional(numberBetween(0.001, 1000)),
});

export type Hypothesis = v.InferOutput<typeof hypothesisSchema>;

/** The parts of a plan that name what is tested as planned. */
export interface PlannedTests {
  readonly planned?: readonly string[];
  readonly hypotheses?: readonly Hypothesis[];
}

/** Returns every planned measure once: those of the hypotheses, and those that the plan names without one. */
export const plannedMeasures = ({ planned = [], hypotheses = [] }: PlannedTests): readonly string[] => [
  ...new Set([...hypotheses.flatMap(({ measures }) => measures), ...planned]),
];

/** Returns the hypothesis about a measure under two conditions, in either order; null: there is none. */
export const hypothesisAbout = (
  measure: string,
  [first, second]: readonly [string, string],
  { hypotheses = [] }: PlannedTests,
): Hypothesis | null =>
  hypotheses.find(
    ({ conditions, measures }) =>
      conditions.includes(first) && conditions.includes(second) && measures.includes(measure),
  ) ?? null;

/** Returns what a hypothesis claims: "paper and ik are equivalent within ±0.5". `labelOf` names a condition. */
export const claimOf = ({ conditions, margin }: Hypothesis, labelOf = (id: string) => id): string =>
  `${conditions.map(labelOf).join(' and ')} ${margin === undefined ? 'differ' : `are equivalent within ±${margin}`}`;

/**
 * Throws a ValidationError if a hypothesis compares a condition with itself or with one that the plan lacks, or if two
 * hypotheses are about the same measure under the same conditions.
 */
export function rejectUnclearHypotheses(hypotheses: readonly Hypothesis[], conditions: readonly string[]): void {
  hypotheses.forEach((hypothesis, index) => {
    const field = `hypotheses[${index}]`;
    hypothesis.conditions.forEach((id, at) => {
      if (conditions.includes(id)) return;
      throw new ValidationError(
        `${field}.conditions[${at}]`,
        `there is no condition "${id}": expected one of ${conditions.join(', ')}`,
      );
    });
    const [first, second] = hypothesis.conditions;
    if (first === second) throw new ValidationError(`${field}.conditions`, `compares "${first}" with itself`);
    const before = hypotheses.slice(0, index);
    hypothesis.measures.forEach((measure, at) => {
      const other = hypothesisAbout(measure, hypothesis.conditions, { hypotheses: before });
      if (other) throw new ValidationError(`${field}.measures[${at}]`, `"${measure}" is a measure of ${other.id} too`);
    });
  });
}
