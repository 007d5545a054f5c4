import { signedRankCdf } from './distributions';
import { noncentralityOfT } from './noncentral';
import { approximateP, cubesOf, exactBelow, type RankTest, rankBiserialInterval, ranksOf } from './ranks';
import { criticalT, type Interval, meanSummary, oneSidedP, roundingOf, type TTest, twoSidedP } from './summaries';

/** Returns first − second, pair by pair. Throws if the lists differ in length or are empty. */
function differencesOf(first: readonly number[], second: readonly number[]): readonly number[] {
  if (first.length !== second.length) {
    throw new Error(`paired values: ${first.length} of the first kind, ${second.length} of the second`);
  }
  if (first.length === 0) throw new Error('paired values: there are none');
  return first.map((value, index) => value - (second[index] as number));
}

/**
 * Returns the mean difference of pairs with its standard error, which is null if the differences do not vary, up to
 * rounding.
 */
function meanDifferenceOf(first: readonly number[], second: readonly number[]) {
  const { n, mean, standardDeviation, interval } = meanSummary(differencesOf(first, second));
  const error = (standardDeviation ?? 0) / Math.sqrt(n);
  const varies = error > roundingOf([...first, ...second]);
  return { n, mean, interval, error: varies ? error : null };
}

/**
 * Computes R's `t.test(first, second, paired = TRUE)`; d is d_z, the mean difference in standard deviations of the
 * differences. Throws if the lists differ in length or are empty.
 */
export function pairedTTest(first: readonly number[], second: readonly number[]): TTest {
  const { n, mean, interval, error } = meanDifferenceOf(first, second);
  const df = n - 1;
  if (error === null) return { meanDifference: mean, interval: null, df, t: null, p: null, d: null, dInterval: null };
  const t = mean / error;
  const noncentrality = noncentralityOfT(t, df);
  const root = Math.sqrt(n);
  const dInterval = noncentrality && { low: noncentrality.low / root, high: noncentrality.high / root };
  return { meanDifference: mean, interval, df, t, p: twoSidedP(t, df), d: t / root, dInterval };
}

/** A paired test of whether the mean difference is smaller than a margin in either direction. */
export interface EquivalenceTest {
  /** The largest mean difference that counts as none, in the unit of the values. */
  readonly margin: number;
  /** The 90 % interval of the mean difference: p is below .05 if it lies between −margin and margin. */
  readonly interval: Interval | null;
  /** The smaller t of the two one-sided tests, which decides; null if the differences do not vary; so is p. */
  readonly t: number | null;
  readonly p: number | null;
}

/** The significance level to which the interval of an equivalence test belongs. */
const equivalenceLevel = 0.05;

/**
 * Computes two one-sided paired t-tests (Schuirmann, Journal of Pharmacokinetics and Biopharmaceutics 15, 1987): the
 * larger p of R's `t.test(first, second, paired = TRUE, mu = -margin, alternative = "greater")` and `mu = margin,
 * alternative = "less"`. Throws if the lists differ in length or are empty.
 */
export function equivalenceTest(first: readonly number[], second: readonly number[], margin: number): EquivalenceTest {
  const { n, mean, error } = meanDifferenceOf(first, second);
  if (error === null) return { margin, interval: null, t: null, p: null };
  const df = n - 1;
  const half = criticalT(1 - 2 * equivalenceLevel, df) * error;
  const t = (margin - Math.abs(mean)) / error;
  return { margin, interval: { low: mean - half, high: mean + half }, t, p: oneSidedP(t, df) };
}

export interface SignedRankTest extends RankTest {
  /** The number of pairs that differ; the others are left out. */
  readonly n: number;
  readonly zeros: number;
}

/**
 * Computes R's `wilcox.test(first, second, paired = TRUE)` up to R 4.5: exact for fewer than 50 pairs without ties and
 * zeros, otherwise the normal approximation with continuity correction, without zeros (Wilcoxon's method). Differences
 * that are equal up to rounding are tied (R: with `digits.rank`), and those within rounding of 0 are zeros. The
 * statistic is V, the sum of the ranks of the positive differences; p and effect are null if no pair differs. Throws if
 * the lists differ in length or are empty.
 */
export function signedRankTest(first: readonly number[], second: readonly number[]): SignedRankTest {
  const all = differencesOf(first, second);
  // The rounding error of large values shows in their small differences.
  const rounding = roundingOf([...first, ...second]);
  const differences = all.filter((difference) => Math.abs(difference) > rounding);
  const n = differences.length;
  const zeros = all.length - n;
  if (n === 0) return { n, zeros, statistic: 0, method: 'exact', p: null, effect: null, effectInterval: null };
  const { ranks, ties } = ranksOf(differences.map(Math.abs), rounding);
  const v = ranks.reduce((sum, rank, index) => sum + ((differences[index] as number) > 0 ? rank : 0), 0);
  const total = (n * (n + 1)) / 2;
  const effect = (2 * v - total) / total;
  const exact = zeros === 0 && ties.length === 0 && n < exactBelow;
  const p = exact ? exactP(v, n) : normalP(v, n, ties);
  const effectInterval = rankBiserialInterval(effect, Math.sqrt((n * (n + 1) * (2 * n + 1)) / 6) / total);
  return { n, zeros, statistic: v, method: exact ? 'exact' : 'normal', p, effect, effectInterval };
}

function exactP(v: number, n: number): number {
  // The distribution is symmetric; the smaller end loses nothing to rounding.
  return Math.min(1, 2 * signedRankCdf(Math.min(v, (n * (n + 1)) / 2 - v), n));
}

function normalP(v: number, n: number, ties: readonly number[]): number {
  const deviation = Math.sqrt((n * (n + 1) * (2 * n + 1)) / 24 - cubesOf(ties) / 48);
  return approximateP(v - (n * (n + 1)) / 4, deviation);
}

/** Returns the two-sided p of a V of n pairs without ties and zeros. */
export const signedRankP = (v: number, n: number): number => (n < exactBelow ? exactP(v, n) : normalP(v, n, []));
