import { normalCdf, signedRankCdf } from './distributions';
import { noncentralityOfT } from './noncentral';
import { cubesOf, rankBiserialInterval, ranksOf } from './ranks';
import { type Interval, meanSummary, roundingOf, twoSidedP } from './summaries';

/** The two-sided paired t-test of first − second. */
export interface PairedTTest {
  readonly n: number;
  /** The mean of the differences. */
  readonly meanDifference: number;
  readonly interval: Interval | null;
  readonly df: number;
  /** null if all differences are equal up to rounding or there are fewer than two, so that there is no variance. */
  readonly t: number | null;
  readonly p: number | null;
  /** Cohen's d_z: the mean of the differences in their standard deviations; null if t is. */
  readonly dz: number | null;
  /** null also if t is too far out to compute it. */
  readonly dzInterval: Interval | null;
}

function refuseUnpaired(first: readonly number[], second: readonly number[]): void {
  if (first.length !== second.length) {
    throw new Error(`paired values: ${first.length} of the first kind, ${second.length} of the second`);
  }
  if (first.length === 0) throw new Error('paired values: there are none');
}

/** Computes R's `t.test(first, second, paired = TRUE)`. Throws if the lists differ in length or are empty. */
export function pairedTTest(first: readonly number[], second: readonly number[], confidence = 0.95): PairedTTest {
  refuseUnpaired(first, second);
  const differences = first.map((value, index) => value - (second[index] as number));
  const { n, mean, standardDeviation, interval } = meanSummary(differences, confidence);
  const df = n - 1;
  const error = (standardDeviation ?? 0) / Math.sqrt(n);
  if (standardDeviation === null || error <= roundingOf([...first, ...second])) {
    return { n, meanDifference: mean, interval: null, df, t: null, p: null, dz: null, dzInterval: null };
  }
  const t = mean / error;
  const noncentrality = noncentralityOfT(t, df, confidence);
  const root = Math.sqrt(n);
  const dzInterval = noncentrality && { low: noncentrality.low / root, high: noncentrality.high / root };
  return { n, meanDifference: mean, interval, df, t, p: twoSidedP(t, df), dz: mean / standardDeviation, dzInterval };
}

/** Wilcoxon's signed-rank test of first − second, two-sided. */
export interface SignedRankTest {
  /** The number of pairs that differ; the others are left out. */
  readonly n: number;
  readonly zeros: number;
  /** The sum of the ranks of the positive differences: R's V. */
  readonly v: number;
  /** exact: the distribution of V; normal: its approximation with correction for continuity and ties. */
  readonly method: 'exact' | 'normal';
  /** null if no pair differs. */
  readonly p: number | null;
  /** The rank-biserial correlation in [−1, 1]: (V − the ranks of the negative) / all ranks; null if no pair differs. */
  readonly effect: number | null;
  /** The interval of the effect; null also if all differences have one sign. */
  readonly effectInterval: Interval | null;
}

/** Below this many pairs R uses the exact distribution, if there are neither ties nor zeros. */
const exactBelow = 50;

/**
 * Computes R's `wilcox.test(first, second, paired = TRUE)` up to R 4.5: exact for fewer than 50 pairs without ties and
 * zeros, otherwise the normal approximation with continuity correction, without zeros (Wilcoxon's method). Differences
 * that are equal up to rounding are tied (R: with `digits.rank`), and those within rounding of 0 are zeros. Throws if
 * the lists differ in length or are empty.
 */
export function signedRankTest(first: readonly number[], second: readonly number[]): SignedRankTest {
  refuseUnpaired(first, second);
  const all = first.map((value, index) => value - (second[index] as number));
  // The rounding error of large values shows in their small differences.
  const rounding = roundingOf([...first, ...second]);
  const differences = all.filter((difference) => Math.abs(difference) > rounding);
  const n = differences.length;
  const zeros = all.length - n;
  if (n === 0) return { n, zeros, v: 0, method: 'exact', p: null, effect: null, effectInterval: null };
  const { ranks, ties } = ranksOf(differences.map(Math.abs), rounding);
  const v = ranks.reduce((sum, rank, index) => sum + ((differences[index] as number) > 0 ? rank : 0), 0);
  const total = (n * (n + 1)) / 2;
  const effect = (2 * v - total) / total;
  const exact = zeros === 0 && ties.length === 0 && n < exactBelow;
  const p = exact ? exactP(v, n) : normalP(v, n, ties);
  const effectInterval = rankBiserialInterval(effect, Math.sqrt((n * (n + 1) * (2 * n + 1)) / 6) / total);
  return { n, zeros, v, method: exact ? 'exact' : 'normal', p, effect, effectInterval };
}

function exactP(v: number, n: number): number {
  // The distribution is symmetric; the smaller end loses nothing to rounding.
  return Math.min(1, 2 * signedRankCdf(Math.min(v, (n * (n + 1)) / 2 - v), n));
}

function normalP(v: number, n: number, ties: readonly number[]): number {
  const deviation = Math.sqrt((n * (n + 1) * (2 * n + 1)) / 24 - cubesOf(ties) / 48);
  const distance = v - (n * (n + 1)) / 4;
  const z = (distance - Math.sign(distance) / 2) / deviation;
  return Math.min(1, 2 * normalCdf(-Math.abs(z)));
}

/** Returns the two-sided p of a V of n pairs without ties and zeros. */
export const signedRankP = (v: number, n: number): number => (n < exactBelow ? exactP(v, n) : normalP(v, n, []));
