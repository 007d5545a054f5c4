import { bisect } from 'threepoint/math';
import { incompleteBeta } from './distributions';

/** The confidence of the intervals of means, differences, d and rank-biserial correlations. */
export const confidence = 0.95;

/** The ends of a confidence interval. */
export interface Interval {
  readonly low: number;
  readonly high: number;
}

/** A mean with its deviation and interval, which are null for fewer than two values. */
export interface MeanSummary {
  readonly n: number;
  readonly mean: number;
  /** The standard deviation of the sample, divided by n − 1. */
  readonly standardDeviation: number | null;
  /** The interval by Student's t with n − 1 degrees of freedom. */
  readonly interval: Interval | null;
}

/** A two-sided t-test of first − second. */
export interface TTest {
  readonly meanDifference: number;
  readonly interval: Interval | null;
  /** null if there is no variance to measure the difference with, up to rounding; so is p. */
  readonly t: number | null;
  /** null without values for it. */
  readonly df: number | null;
  readonly p: number | null;
  /** Cohen's d; null if t is. */
  readonly d: number | null;
  /** null also if t is too far out to compute it. */
  readonly dInterval: Interval | null;
}

export const sumOf = (values: readonly number[]): number => values.reduce((sum, value) => sum + value, 0);

/** Returns the arithmetic mean, NaN for no values. */
export const meanOf = (values: readonly number[]): number => sumOf(values) / values.length;

/** Returns the standard deviation of the sample, divided by n − 1; NaN for fewer than two values. */
export function deviationOf(values: readonly number[]): number {
  const mean = meanOf(values);
  return Math.sqrt(sumOf(values.map((value) => (value - mean) ** 2)) / (values.length - 1));
}

/** Returns the t between −t and t of which this share of Student's distribution lies. */
export function criticalT(share: number, df: number): number {
  // t² / (df + t²) has a beta distribution.
  const x = bisect(0, 1, (at) => incompleteBeta(at, 0.5, df / 2) > share, 100);
  return Math.sqrt((df * x) / (1 - x));
}

/** Returns the mean with its confidence interval; throws for no values. */
export function meanSummary(values: readonly number[]): MeanSummary {
  const n = values.length;
  if (n === 0) throw new Error('the mean of no values is not defined');
  const mean = meanOf(values);
  if (n < 2) return { n, mean, standardDeviation: null, interval: null };
  const standardDeviation = deviationOf(values);
  const half = (criticalT(confidence, n - 1) * standardDeviation) / Math.sqrt(n);
  return { n, mean, standardDeviation, interval: { low: mean - half, high: mean + half } };
}

/** Returns the probability of a t at least this far from 0 on either side, with df degrees of freedom. */
export const twoSidedP = (t: number, df: number): number => incompleteBeta(df / (df + t * t), df / 2, 0.5);

/** Returns the probability of a t at least this large, with df degrees of freedom. */
export const oneSidedP = (t: number, df: number): number => (t < 0 ? 1 - twoSidedP(t, df) / 2 : twoSidedP(t, df) / 2);

/** The share of the largest input up to which two values are equal but for rounding. */
const equalWithin = 1e-9;

/**
 * Returns the rounding error of a figure that is computed from these values, in their unit. Means of thirds, their
 * differences and means of means differ in the last digits although they are equal.
 */
export const roundingOf = (values: readonly number[]): number =>
  equalWithin * values.reduce((largest, value) => Math.max(largest, Math.abs(value)), 0);
