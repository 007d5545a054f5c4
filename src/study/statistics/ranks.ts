import { bisect } from 'threepoint/math';
import { normalCdf } from './distributions';
import { confidence, type Interval, roundingOf } from './summaries';

/** A two-sided test of first − second by ranks. */
export interface RankTest {
  /** V or W of Wilcoxon's tests. */
  readonly statistic: number;
  /** exact: the distribution of the statistic; normal: its approximation with correction for continuity and ties. */
  readonly method: 'exact' | 'normal';
  /** null if nothing differs. */
  readonly p: number | null;
  /** The rank-biserial correlation in [−1, 1]: (ranks for − ranks against) / all ranks. */
  readonly effect: number | null;
  /** The interval of the effect; null also if all ranks are on one side. */
  readonly effectInterval: Interval | null;
}

/** Below this many pairs, or values in each group, R uses the exact distribution, if there are no ties or zeros. */
export const exactBelow = 50;

/** Returns the two-sided p of a statistic at this distance from its mean, by the normal approximation. */
export function approximateP(distance: number, deviation: number): number {
  const z = (distance - Math.sign(distance) / 2) / deviation;
  return Math.min(1, 2 * normalCdf(-Math.abs(z)));
}

/**
 * Returns ranks from 1, with the mean rank for ties, and the sizes of the groups of ties. Adjacent values are tied if
 * they differ by at most `rounding`; 0: if they are equal.
 */
export function ranksOf(
  values: readonly number[],
  rounding = roundingOf(values),
): {
  readonly ranks: readonly number[];
  readonly ties: readonly number[];
} {
  const order = values.map((_, index) => index).toSorted((a, b) => (values[a] as number) - (values[b] as number));
  const gapBefore = (at: number) =>
    (values[order[at] as number] as number) - (values[order[at - 1] as number] as number);
  const ranks = new Array<number>(values.length);
  const ties: number[] = [];
  for (let start = 0; start < order.length; ) {
    let end = start + 1;
    while (end < order.length && gapBefore(end) <= rounding) end += 1;
    for (let i = start; i < end; i++) ranks[order[i] as number] = (start + 1 + end) / 2;
    if (end - start > 1) ties.push(end - start);
    start = end;
  }
  return { ranks, ties };
}

/** Returns Σ (size³ − size) over groups of ties, by which they reduce the variance of ranks. */
export const cubesOf = (ties: readonly number[]): number => ties.reduce((sum, size) => sum + size ** 3 - size, 0);

/**
 * Returns the interval of a rank-biserial correlation by Fisher's z, as R's effectsize::rank_biserial. `error` is the
 * standard error without a difference. null: all ranks are on one side, hence z is infinite.
 */
export function rankBiserialInterval(effect: number, error: number): Interval | null {
  if (Math.abs(effect) === 1) return null;
  const critical = bisect(0, 40, (z) => normalCdf(z) > (1 + confidence) / 2, 80);
  const z = Math.atanh(effect);
  return { low: Math.tanh(z - critical * error), high: Math.tanh(z + critical * error) };
}
