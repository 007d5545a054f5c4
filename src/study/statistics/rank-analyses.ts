import { gammaTail } from './distributions';
import { cubesOf, ranksOf } from './ranks';
import { roundingOf, sumOf } from './summaries';

/** A test of several conditions or cohorts by ranks, by its χ² approximation. */
export interface RankAnalysis {
  readonly chiSquared: number | null;
  readonly df: number;
  /** null if nothing differs. */
  readonly p: number | null;
  /** The effect in [0, 1]: Kendall's W, or for cohorts ε² = H / (n − 1); null if p is. */
  readonly effect: number | null;
}

/** The upper tail of the χ² distribution, computed directly: 1 minus the rest would round small tails away. */
const upperTail = (chiSquared: number, df: number) => gammaTail(df / 2, chiSquared / 2);

/**
 * Computes R's `friedman.test` of `participants[p][k]`, participant p under condition k. Throws without participants.
 */
export function friedmanTest(participants: readonly (readonly number[])[]): RankAnalysis {
  const n = participants.length;
  const k = participants[0]?.length ?? 0;
  if (n === 0 || k < 2) throw new Error("Friedman's test needs participants and two conditions");
  const rounding = roundingOf(participants.flat());
  const ranked = participants.map((own) => ranksOf(own, rounding));
  const sums = Array.from({ length: k }, (_, at) => sumOf(ranked.map(({ ranks }) => ranks[at] as number)));
  const spread = n * k * (k + 1) - sumOf(ranked.map(({ ties }) => cubesOf(ties))) / (k - 1);
  const df = k - 1;
  if (spread === 0) return { chiSquared: null, df, p: null, effect: null };
  const expected = (n * (k + 1)) / 2;
  const chiSquared = (12 * sumOf(sums.map((value) => (value - expected) ** 2))) / spread;
  return { chiSquared, df, p: upperTail(chiSquared, df), effect: chiSquared / (n * df) };
}

/** Computes R's `kruskal.test` of the values of each cohort. Throws if one is empty. */
export function kruskalWallisTest(cohorts: readonly (readonly number[])[]): RankAnalysis {
  if (cohorts.length < 2 || cohorts.some(({ length }) => length === 0)) {
    throw new Error("Kruskal and Wallis's test needs two cohorts and values in each");
  }
  const { ranks, ties } = ranksOf(cohorts.flat());
  const n = ranks.length;
  const df = cohorts.length - 1;
  const correction = 1 - cubesOf(ties) / (n ** 3 - n);
  if (correction === 0) return { chiSquared: null, df, p: null, effect: null };
  let start = 0;
  let squares = 0;
  for (const { length } of cohorts) {
    const sum = sumOf(ranks.slice(start, start + length));
    squares += (sum * sum) / length;
    start += length;
  }
  const chiSquared = ((12 * squares) / (n * (n + 1)) - 3 * (n + 1)) / correction;
  return { chiSquared, df, p: upperTail(chiSquared, df), effect: chiSquared / (n - 1) };
}
