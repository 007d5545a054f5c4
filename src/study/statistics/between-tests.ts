import normalCdf from '@stdlib/stats-base-dists-normal-cdf';
import { noncentralityOfT } from './noncentral';
import { cubesOf, rankBiserialInterval, ranksOf } from './ranks';
import { criticalT, deviationOf, type Interval, meanOf, roundingOf, twoSidedP } from './summaries';

/** Welch's two-sided t-test of first − second, of different participants. */
export interface WelchTest {
  readonly n: readonly [number, number];
  readonly meanDifference: number;
  readonly interval: Interval | null;
  /** null where there is no spread to measure the difference with; so are p and df. */
  readonly t: number | null;
  readonly df: number | null;
  readonly p: number | null;
  /** Cohen's d_s: the difference in pooled standard deviations. */
  readonly ds: number | null;
  readonly dsInterval: Interval | null;
}

function refuseEmpty(first: readonly number[], second: readonly number[]): void {
  if (first.length === 0 || second.length === 0) throw new Error('two groups: one of them is empty');
}

/** Of the difference of two means, and its degrees of freedom by Welch and Satterthwaite. */
export function standardError(
  variances: readonly [number, number],
  n: readonly [number, number],
): { readonly error: number; readonly df: number } {
  const shares = [variances[0] / n[0], variances[1] / n[1]] as const;
  const sum = shares[0] + shares[1];
  return { error: Math.sqrt(sum), df: sum ** 2 / (shares[0] ** 2 / (n[0] - 1) + shares[1] ** 2 / (n[1] - 1)) };
}

/** As R's `t.test(first, second)`. Throws where a list is empty. */
export function welchTest(first: readonly number[], second: readonly number[], confidence = 0.95): WelchTest {
  refuseEmpty(first, second);
  const n = [first.length, second.length] as const;
  const means = [meanOf(first), meanOf(second)] as const;
  const meanDifference = means[0] - means[1];
  const untested = { n, meanDifference, interval: null, t: null, df: null, p: null, ds: null, dsInterval: null };
  if (n[0] < 2 || n[1] < 2) return untested;
  const variances = [deviationOf(first) ** 2, deviationOf(second) ** 2] as const;
  const { error, df } = standardError(variances, n);
  if (error <= roundingOf([...first, ...second])) return untested;
  const t = meanDifference / error;
  const half = criticalT(confidence, df) * error;
  const pooledDf = n[0] + n[1] - 2;
  const pooled = Math.sqrt(((n[0] - 1) * variances[0] + (n[1] - 1) * variances[1]) / pooledDf);
  // Student's t, whose noncentrality is the effect in these units.
  const unit = Math.sqrt(1 / n[0] + 1 / n[1]);
  const ds = meanDifference / pooled;
  const noncentrality = noncentralityOfT(ds / unit, pooledDf, confidence);
  return {
    n,
    meanDifference,
    interval: { low: meanDifference - half, high: meanDifference + half },
    t,
    df,
    p: twoSidedP(t, df),
    ds,
    dsInterval: noncentrality && { low: noncentrality.low * unit, high: noncentrality.high * unit },
  };
}

/** Wilcoxon's rank-sum test (Mann and Whitney's) of first − second, two-sided. */
export interface RankSumTest {
  /** Pairs of one value of each in which the first is larger, ties counting half: R's W. */
  readonly w: number;
  readonly method: 'exact' | 'normal';
  /** null where all values are alike. */
  readonly p: number | null;
  /** Rank-biserial correlation in [−1, 1]: how much likelier a value of the first is the larger than the smaller. */
  readonly effect: number;
  /** Its interval; null where no value of one is beyond one of the other. */
  readonly effectInterval: Interval | null;
}

/** From as many values on, or with ties, R takes the normal approximation. */
const exactBelow = 50;

/** How many of the ways to choose `first` ranks of first + second have each value of W. */
export function rankSumCounts(first: number, second: number): readonly number[] {
  // ways[i][w]: of i chosen among the ranks so far.
  const ways = Array.from({ length: first + 1 }, () => new Array<number>(first * second + 1).fill(0));
  (ways[0] as number[])[0] = 1;
  for (let rank = 1; rank <= first + second; rank++) {
    for (let chosen = Math.min(first, rank); chosen > 0; chosen--) {
      // The chosen-th of them at this rank is larger than so many of the second kind.
      const wins = rank - chosen;
      const [without, withIt] = [ways[chosen] as number[], ways[chosen - 1] as number[]];
      for (let w = first * second; w >= wins; w--) (without[w] as number) += withIt[w - wins] as number;
    }
  }
  return ways[first] as number[];
}

/** The exact two-sided p of every W of so many values, which are counted once for all. */
function exactPs(first: number, second: number): (w: number) => number {
  const counts = rankSumCounts(first, second);
  const all = counts.reduce((sum, count) => sum + count, 0);
  let sum = 0;
  const upTo = counts.map((count) => {
    sum += count;
    return sum;
  });
  // Both ends are alike: the sum of the smaller one loses nothing to rounding.
  return (w) => Math.min(1, 2 * ((upTo[Math.min(w, first * second - w)] as number) / all));
}

/**
 * As R's `wilcox.test(first, second)` up to R 4.5: exact for fewer than 50 values in each group without ties, else the normal approximation
 * with continuity correction. Throws where a list is empty.
 */
export function rankSumTest(first: readonly number[], second: readonly number[]): RankSumTest {
  refuseEmpty(first, second);
  const [m, n] = [first.length, second.length];
  const { ranks, ties } = ranksOf([...first, ...second]);
  const w = ranks.slice(0, m).reduce((sum, rank) => sum + rank, 0) - (m * (m + 1)) / 2;
  const effect = (2 * w) / (m * n) - 1;
  const exact = ties.length === 0 && m < exactBelow && n < exactBelow;
  const effectInterval = rankBiserialInterval(effect, Math.sqrt((m + n + 1) / (3 * m * n)));
  const p = exact ? exactPs(m, n)(w) : normalP(w, m, n, ties);
  return { w, method: exact ? 'exact' : 'normal', p, effect, effectInterval };
}

/** null where all values are tied. */
function normalP(w: number, m: number, n: number, ties: readonly number[]): number | null {
  const all = m + n;
  const deviation = Math.sqrt(((m * n) / 12) * (all + 1 - cubesOf(ties) / (all * (all - 1))));
  if (deviation === 0) return null;
  const distance = w - (m * n) / 2;
  const z = (distance - Math.sign(distance) / 2) / deviation;
  return Math.min(1, 2 * normalCdf(-Math.abs(z), 0, 1));
}

/** The two-sided p of each W of m and n values that are all different. */
export const rankSumPs = (m: number, n: number): ((w: number) => number) =>
  m < exactBelow && n < exactBelow ? exactPs(m, n) : (w) => normalP(w, m, n, []) as number;
