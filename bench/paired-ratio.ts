import { meanSummary } from '../src/study/statistics/summaries';

/** How many times as much the first of two costs as the second. */
export interface PairedRatio {
  /** Geometric mean of the ratios. */
  readonly ratio: number;
  /** Its 95 % confidence interval. */
  readonly low: number;
  readonly high: number;
  readonly pairs: number;
}

/**
 * The ratio of two costs that were measured side by side, pair by pair (each above 0; as many of either): what else the
 * machine did then was in both. By the t distribution of the ratios' logarithms, so that twice and half as much weigh
 * alike. NaN below two pairs.
 */
export function pairedRatio(first: readonly number[], second: readonly number[]): PairedRatio {
  const pairs = first.length;
  if (pairs < 2 || pairs !== second.length) return { ratio: Number.NaN, low: Number.NaN, high: Number.NaN, pairs };
  const { mean, interval } = meanSummary(first.map((cost, i) => Math.log(cost / second[i]!)));
  return { ratio: Math.exp(mean), low: Math.exp(interval?.low ?? mean), high: Math.exp(interval?.high ?? mean), pairs };
}
