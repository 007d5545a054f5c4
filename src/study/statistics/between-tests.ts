import { noncentralityOfT } from './noncentral';
import { approximateP, cubesOf, exactBelow, type RankTest, rankBiserialInterval, ranksOf } from './ranks';
import { confidence, criticalT, deviationOf, meanOf, roundingOf, sumOf, type TTest, twoSidedP } from './summaries';

function rejectEmpty(first: readonly number[], second: readonly number[]): void {
  if (first.length === 0 || second.length === 0) throw new Error('two groups: one of them is empty');
}

/** Returns the standard error of the difference of two means, and its degrees of freedom by Welch and Satterthwaite. */
export function standardError(
  variances: readonly [number, number],
  n: readonly [number, number],
): { readonly error: number; readonly df: number } {
  const shares = [variances[0] / n[0], variances[1] / n[1]] as const;
  const sum = shares[0] + shares[1];
  return { error: Math.sqrt(sum), df: sum ** 2 / (shares[0] ** 2 / (n[0] - 1) + shares[1] ** 2 / (n[1] - 1)) };
}

/**
 * Computes Welch's t-test of different participants as R's `t.test(first, second)`; d is d_s, the difference in pooled
 * standard deviations. Throws if a list is empty.
 */
export function welchTest(first: readonly number[], second: readonly number[]): TTest {
  rejectEmpty(first, second);
  const n = [first.length, second.length] as const;
  const means = [meanOf(first), meanOf(second)] as const;
  const meanDifference = means[0] - means[1];
  const untested = { meanDifference, interval: null, t: null, df: null, p: null, d: null, dInterval: null };
  if (n[0] < 2 || n[1] < 2) return untested;
  const variances = [deviationOf(first) ** 2, deviationOf(second) ** 2] as const;
  const { error, df } = standardError(variances, n);
  if (error <= roundingOf([...first, ...second])) return untested;
  const t = meanDifference / error;
  const half = criticalT(confidence, df) * error;
  const pooledDf = n[0] + n[1] - 2;
  const pooled = Math.sqrt(((n[0] - 1) * variances[0] + (n[1] - 1) * variances[1]) / pooledDf);
  // The factor from Student's t to its noncentrality, which is the effect.
  const unit = Math.sqrt(1 / n[0] + 1 / n[1]);
  const d = meanDifference / pooled;
  const noncentrality = noncentralityOfT(d / unit, pooledDf);
  return {
    meanDifference,
    interval: { low: meanDifference - half, high: meanDifference + half },
    t,
    df,
    p: twoSidedP(t, df),
    d,
    dInterval: noncentrality && { low: noncentrality.low * unit, high: noncentrality.high * unit },
  };
}

/** Counts the ways to choose `first` of first + second ranks for each value of W. */
export function rankSumCounts(first: number, second: number): readonly number[] {
  // ways[i][w] counts the ways to choose i of the ranks so far.
  const ways = Array.from({ length: first + 1 }, () => new Array<number>(first * second + 1).fill(0));
  (ways[0] as number[])[0] = 1;
  for (let rank = 1; rank <= first + second; rank++) {
    for (let chosen = Math.min(first, rank); chosen > 0; chosen--) {
      // The number of values of the second kind that are smaller than this one.
      const wins = rank - chosen;
      const [without, withIt] = [ways[chosen] as number[], ways[chosen - 1] as number[]];
      for (let w = first * second; w >= wins; w--) (without[w] as number) += withIt[w - wins] as number;
    }
  }
  return ways[first] as number[];
}

/** Returns a function from W to its exact two-sided p, which counts once for all W. */
function exactPs(first: number, second: number): (w: number) => number {
  const counts = rankSumCounts(first, second);
  const all = sumOf(counts);
  let sum = 0;
  const upTo = counts.map((count) => {
    sum += count;
    return sum;
  });
  // The distribution is symmetric; the sum of the smaller end loses nothing to rounding.
  return (w) => Math.min(1, 2 * ((upTo[Math.min(w, first * second - w)] as number) / all));
}

/**
 * Computes Wilcoxon's rank-sum test (Mann and Whitney's) as R's `wilcox.test(first, second)` up to R 4.5: exact for
 * fewer than 50 values in each group without ties, otherwise the normal approximation with continuity correction. The
 * statistic is W, the number of pairs in which the first is larger, ties counting half; p is null if all values are
 * equal. Throws if a list is empty.
 */
export function rankSumTest(first: readonly number[], second: readonly number[]): RankTest {
  rejectEmpty(first, second);
  const [m, n] = [first.length, second.length];
  const { ranks, ties } = ranksOf([...first, ...second]);
  const w = sumOf(ranks.slice(0, m)) - (m * (m + 1)) / 2;
  const effect = (2 * w) / (m * n) - 1;
  const exact = ties.length === 0 && m < exactBelow && n < exactBelow;
  const effectInterval = rankBiserialInterval(effect, Math.sqrt((m + n + 1) / (3 * m * n)));
  const p = exact ? exactPs(m, n)(w) : normalP(w, m, n, ties);
  return { statistic: w, method: exact ? 'exact' : 'normal', p, effect, effectInterval };
}

/** Returns null if all values are tied. */
function normalP(w: number, m: number, n: number, ties: readonly number[]): number | null {
  const all = m + n;
  const deviation = Math.sqrt(((m * n) / 12) * (all + 1 - cubesOf(ties) / (all * (all - 1))));
  if (deviation === 0) return null;
  return approximateP(w - (m * n) / 2, deviation);
}

/** Returns a function from W to its two-sided p for m and n values without ties. */
export const rankSumPs = (m: number, n: number): ((w: number) => number) =>
  m < exactBelow && n < exactBelow ? exactPs(m, n) : (w) => normalP(w, m, n, []) as number;
