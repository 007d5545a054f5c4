import { asFamily } from '../../statistics/holm';
import { pairedTTest, signedRankTest } from '../../statistics/paired-tests';
import type { RankTest } from '../../statistics/ranks';
import { type MeanSummary, meanSummary, type TTest } from '../../statistics/summaries';
import type { Exclusion, Measure, MeasureName } from './measures';

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
  /** Adjusted over the family of comparisons made together. */
  readonly holmP: number | null;
  readonly ranksHolmP: number | null;
}

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
  measured: readonly (MeasureName & Pick<Comparison, 'values'>)[],
  tests: (first: readonly number[], second: readonly number[]) => Pick<Comparison, 'test' | 'ranks'>,
): readonly Comparison[] =>
  asFamily(
    measured.map(({ of, asked, unit, values }) => {
      const [first, second] = [values.first, values.second].map((own) => (own.length === 0 ? null : meanSummary(own)));
      const tested = first && second ? tests(values.first, values.second) : { test: null, ranks: null };
      return { of, asked, unit, values, first: first ?? null, second: second ?? null, ...tested };
    }),
    ({ test }) => test?.p ?? null,
    ({ ranks }) => ranks?.p ?? null,
  );

/**
 * Compares measures between two conditions, first − second, as one family for Holm's correction. Only participants with
 * both values count; others are listed.
 */
export function compareConditions(measures: readonly Measure[], conditions: readonly [string, string]): Results {
  const excluded: Exclusion[] = [];
  const measured = measures.map((measure) => {
    const { values, alone } = paired(measure, conditions);
    for (const { condition, ...reason } of measure.voided) if (conditions.includes(condition)) excluded.push(reason);
    excluded.push(...alone);
    return { ...measure, values };
  });
  const comparisons = comparisonsOf(measured, (first, second) => ({
    test: pairedTTest(first, second),
    ranks: signedRankTest(first, second),
  }));
  return { comparisons, excluded };
}
