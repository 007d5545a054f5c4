import { asFamily } from '../../statistics/holm';
import { type EquivalenceTest, equivalenceTest, pairedTTest, signedRankTest } from '../../statistics/paired-tests';
import type { RankTest } from '../../statistics/ranks';
import { type MeanSummary, meanSummary, type TTest } from '../../statistics/summaries';
import { type Hypothesis, hypothesisAbout, type PlannedTests } from '../plan/hypotheses';
import { type Exclusion, type Measure, type MeasureName, nameInPlan } from './measures';

/** The comparison of a measure under two conditions (paired tests) or between two cohorts: first − second. */
export interface Comparison extends MeasureName {
  /** null: no one has a value. */
  readonly first: MeanSummary | null;
  readonly second: MeanSummary | null;
  /**
   * The value of each participant (or group) in order. Values of two conditions at one index are a pair, those of
   * cohorts are of different participants.
   */
  readonly values: { readonly first: readonly number[]; readonly second: readonly number[] };
  /** null: a side has no values. */
  readonly test: TTest | null;
  readonly ranks: RankTest | null;
  /** What the plan claims about the measure under these conditions; null: nothing, or cohorts are compared. */
  readonly hypothesis: Hypothesis | null;
  /** null: a side has no values, or there is no hypothesis with a margin. */
  readonly equivalence: EquivalenceTest | null;
  /** Adjusted over the family of comparisons made together. */
  readonly holmP: number | null;
  readonly ranksHolmP: number | null;
  /** Adjusted over the tests of equivalence in the family. */
  readonly equivalenceHolmP: number | null;
}

type Tests = Pick<Comparison, 'test' | 'ranks' | 'equivalence'>;

export interface Results {
  readonly comparisons: readonly Comparison[];
  readonly excluded: readonly Exclusion[];
}

/** Returns the values of participants who have both, and the names of those who lack one. */
function paired({ of, means }: Measure, [first, second]: readonly [string, string]) {
  const values = { first: [] as number[], second: [] as number[] };
  const alone: Exclusion[] = [];
  for (const [who, own] of means) {
    const [one, other] = [own.get(first), own.get(second)];
    if (one !== undefined && other !== undefined) {
      values.first.push(one);
      values.second.push(other);
    } else if (one !== undefined || other !== undefined) {
      alone.push({ participant: who, of, reason: `no valid value under "${one === undefined ? first : second}"` });
    }
  }
  return { values, alone };
}

/** Returns comparisons of measures as one family for Holm's correction; `tests` are those of two sides with values. */
export const comparisonsOf = (
  measured: readonly (MeasureName & Pick<Comparison, 'values' | 'hypothesis'>)[],
  tests: (values: Comparison['values'], margin: number | undefined) => Tests,
): readonly Comparison[] =>
  asFamily(
    measured.map(({ of, asked, unit, values, hypothesis }) => {
      const [first, second] = [values.first, values.second].map((own) => (own.length === 0 ? null : meanSummary(own)));
      const untested = { test: null, ranks: null, equivalence: null };
      const tested = first && second ? tests(values, hypothesis?.margin) : untested;
      return { of, asked, unit, values, hypothesis, first: first ?? null, second: second ?? null, ...tested };
    }),
    {
      holmP: ({ test }) => test?.p ?? null,
      ranksHolmP: ({ ranks }) => ranks?.p ?? null,
      equivalenceHolmP: ({ hypothesis, equivalence }) =>
        hypothesis?.margin === undefined ? undefined : (equivalence?.p ?? null),
    },
  );

/**
 * Compares measures between two conditions, first − second, as one family for Holm's correction, with the plan's
 * hypotheses about them. Only participants with both values count; others are listed.
 */
export function compareConditions(
  measures: readonly Measure[],
  conditions: readonly [string, string],
  plan: PlannedTests,
): Results {
  const excluded: Exclusion[] = [];
  const measured = measures.map((measure) => {
    const { values, alone } = paired(measure, conditions);
    for (const { condition, ...reason } of measure.voided) if (conditions.includes(condition)) excluded.push(reason);
    excluded.push(...alone);
    const name = nameInPlan(measure);
    return { ...measure, values, hypothesis: name === null ? null : hypothesisAbout(name, conditions, plan) };
  });
  const comparisons = comparisonsOf(measured, ({ first, second }, margin) => ({
    test: pairedTTest(first, second),
    ranks: signedRankTest(first, second),
    equivalence: margin === undefined ? null : equivalenceTest(first, second, margin),
  }));
  return { comparisons, excluded };
}
