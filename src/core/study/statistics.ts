import normalCdf from '@stdlib/stats-base-dists-normal-cdf';
import signedRankCdf from '@stdlib/stats-base-dists-signrank-cdf';
import tCdf from '@stdlib/stats-base-dists-t-cdf';
import tQuantile from '@stdlib/stats-base-dists-t-quantile';

/** Both ends of a confidence interval. */
export interface Interval {
  readonly low: number;
  readonly high: number;
}

/** A mean, and where it may lie; deviation and interval are null for fewer than two values. */
export interface MeanSummary {
  readonly n: number;
  readonly mean: number;
  /** Of the sample: divided by n − 1. */
  readonly standardDeviation: number | null;
  /** By Student's t with n − 1 degrees of freedom. */
  readonly interval: Interval | null;
}

const meanOf = (values: readonly number[]) => values.reduce((sum, value) => sum + value, 0) / values.length;

function deviationOf(values: readonly number[]): number {
  const mean = meanOf(values);
  return Math.sqrt(values.reduce((sum, value) => sum + (value - mean) ** 2, 0) / (values.length - 1));
}

/** t that a share `confidence` of Student's distribution lies within, both sides of 0. */
const criticalT = (confidence: number, df: number) => tQuantile((1 + confidence) / 2, df);

/** Mean with its confidence interval; throws for no values. */
export function meanSummary(values: readonly number[], confidence = 0.95): MeanSummary {
  const n = values.length;
  if (n === 0) throw new Error('the mean of no values is not defined');
  const mean = meanOf(values);
  if (n < 2) return { n, mean, standardDeviation: null, interval: null };
  const standardDeviation = deviationOf(values);
  const half = (criticalT(confidence, n - 1) * standardDeviation) / Math.sqrt(n);
  return { n, mean, standardDeviation, interval: { low: mean - half, high: mean + half } };
}

/** Probability of a t at least this far from 0, to either side, with df degrees of freedom. */
export const twoSidedP = (t: number, df: number): number => Math.min(1, 2 * tCdf(-Math.abs(t), df));

/** The two-sided paired t-test of first − second. */
export interface PairedTTest {
  readonly n: number;
  /** Of the differences. */
  readonly meanDifference: number;
  readonly interval: Interval | null;
  readonly df: number;
  /** null where all differences are alike (or there are fewer than two): there is no spread to measure the mean with. */
  readonly t: number | null;
  readonly p: number | null;
  /** Cohen's d_z: mean of the differences in their standard deviations; null where t is. */
  readonly dz: number | null;
}

/** Differences this small against the values themselves are rounding: R calls such data essentially constant, by this very bound. */
const constantBelow = 10 * Number.EPSILON;

function refuseUnpaired(first: readonly number[], second: readonly number[]): void {
  if (first.length !== second.length) {
    throw new Error(`paired values: ${first.length} of the first kind, ${second.length} of the second`);
  }
  if (first.length === 0) throw new Error('paired values: there are none');
}

/** As R's `t.test(first, second, paired = TRUE)`. Throws where the lists differ in length or are empty. */
export function pairedTTest(first: readonly number[], second: readonly number[], confidence = 0.95): PairedTTest {
  refuseUnpaired(first, second);
  const differences = first.map((value, index) => value - (second[index] as number));
  const { n, mean, standardDeviation, interval } = meanSummary(differences, confidence);
  const df = n - 1;
  const error = (standardDeviation ?? 0) / Math.sqrt(n);
  if (standardDeviation === null || error <= constantBelow * Math.abs(mean)) {
    return { n, meanDifference: mean, interval: null, df, t: null, p: null, dz: null };
  }
  const t = mean / error;
  return { n, meanDifference: mean, interval, df, t, p: twoSidedP(t, df), dz: mean / standardDeviation };
}

/** Wilcoxon's signed-rank test of first − second, two-sided. */
export interface SignedRankTest {
  /** Pairs that differ; the others say nothing and are left out. */
  readonly n: number;
  readonly zeros: number;
  /** Sum of the ranks of the positive differences: R's V. */
  readonly v: number;
  /** exact: the distribution of V; normal: its approximation with correction for continuity and ties. */
  readonly method: 'exact' | 'normal';
  /** null where no pair differs. */
  readonly p: number | null;
  /** Rank-biserial correlation in [−1, 1]: (V − the ranks of the negative) / all ranks; null where no pair differs. */
  readonly effect: number | null;
}

/** Below this many pairs R takes the exact distribution, if there are neither ties nor zeros. */
const exactBelow = 50;

/** Ranks from 1, ties sharing their mean rank, and the sizes of the groups of ties. */
function ranksOf(values: readonly number[]): { readonly ranks: readonly number[]; readonly ties: readonly number[] } {
  const order = values.map((_, index) => index).toSorted((a, b) => (values[a] as number) - (values[b] as number));
  const ranks = new Array<number>(values.length);
  const ties: number[] = [];
  for (let start = 0; start < order.length; ) {
    let end = start + 1;
    while (end < order.length && values[order[end] as number] === values[order[start] as number]) end += 1;
    for (let i = start; i < end; i++) ranks[order[i] as number] = (start + 1 + end) / 2;
    if (end - start > 1) ties.push(end - start);
    start = end;
  }
  return { ranks, ties };
}

/**
 * As R's `wilcox.test(first, second, paired = TRUE)` up to R 4.5: exact for fewer than 50 pairs without ties and zeros, else the
 * normal approximation with continuity correction, zeros dropped (Wilcoxon's way). Throws where the lists differ in length or are
 * empty.
 */
export function signedRankTest(first: readonly number[], second: readonly number[]): SignedRankTest {
  refuseUnpaired(first, second);
  const all = first.map((value, index) => value - (second[index] as number));
  const differences = all.filter((difference) => difference !== 0);
  const n = differences.length;
  const zeros = all.length - n;
  if (n === 0) return { n, zeros, v: 0, method: 'exact', p: null, effect: null };
  const { ranks, ties } = ranksOf(differences.map(Math.abs));
  const v = ranks.reduce((sum, rank, index) => sum + ((differences[index] as number) > 0 ? rank : 0), 0);
  const total = (n * (n + 1)) / 2;
  const effect = (2 * v - total) / total;
  if (zeros === 0 && ties.length === 0 && n < exactBelow) {
    const tail = v > total / 2 ? 1 - signedRankCdf(v - 1, n) : signedRankCdf(v, n);
    return { n, zeros, v, method: 'exact', p: Math.min(1, 2 * tail), effect };
  }
  const tied = ties.reduce((sum, size) => sum + size ** 3 - size, 0);
  const deviation = Math.sqrt((n * (n + 1) * (2 * n + 1)) / 24 - tied / 48);
  const distance = v - total / 2;
  const z = (distance - Math.sign(distance) / 2) / deviation;
  return { n, zeros, v, method: 'normal', p: Math.min(1, 2 * normalCdf(-Math.abs(z), 0, 1)), effect };
}

/**
 * Holm's adjusted p-values (Scandinavian Journal of Statistics 6, 1979) in the order given. A test without a p (null) stays
 * without one but counts in the family: it was planned, so leaving it out would make the others look better.
 */
export function holm(pValues: readonly (number | null)[]): readonly (number | null)[] {
  const order = pValues
    .map((p, index) => ({ p, index }))
    .filter((test): test is { p: number; index: number } => test.p !== null)
    .toSorted((a, b) => a.p - b.p);
  const adjusted: (number | null)[] = pValues.map(() => null);
  let largest = 0;
  order.forEach(({ p, index }, rank) => {
    largest = Math.max(largest, Math.min(1, (pValues.length - rank) * p));
    adjusted[index] = largest;
  });
  return adjusted;
}
