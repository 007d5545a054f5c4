import { bisect } from 'threepoint/math';
import { cached, incompleteBeta, normalCdf } from './distributions';
import { confidence, type Interval } from './summaries';

/** The confidence of the interval of a share of variance, which is one-sided. */
const shareConfidence = 0.9;
/** Terms of a series this small relative to its greatest add nothing to a double. */
const negligible = 1e-17;
const halvings = 80;

/** Returns the probability of an F at least this large. */
export const fTail = (f: number, df1: number, df2: number): number =>
  f <= 0 ? 1 : incompleteBeta(df2 / (df2 + df1 * f), df2 / 2, df1 / 2);

/**
 * Returns the distribution function at t of the noncentral t with df degrees of freedom, as a function of the
 * noncentrality (Lenth 1989, AS 243).
 */
export function noncentralT(t: number, df: number): (noncentrality: number) => number {
  if (t < 0) {
    const mirrored = noncentralT(-t, df);
    return (noncentrality) => 1 - mirrored(-noncentrality);
  }
  const x = (t * t) / (t * t + df);
  // The search for a noncentrality repeats the arguments.
  const even = cached((j) => incompleteBeta(x, j + 0.5, df / 2));
  const odd = cached((j) => incompleteBeta(x, j + 1, df / 2));
  return (noncentrality) => {
    const half = (noncentrality * noncentrality) / 2;
    let p = Math.exp(-half);
    let q = noncentrality * Math.sqrt(2 / Math.PI) * p;
    let sum = 0;
    for (let j = 0; j < half || Math.abs(p) + Math.abs(q) > negligible; j++) {
      sum += p * even(j) + q * odd(j);
      p *= half / (j + 1);
      q *= half / (j + 1.5);
    }
    return Math.min(1, Math.max(0, normalCdf(-noncentrality) + sum / 2));
  };
}

/**
 * Returns the distribution function at F of the noncentral F, as a function of the noncentrality λ: central ones with
 * Poisson weights.
 */
export function noncentralF(f: number, df1: number, df2: number): (noncentrality: number) => number {
  const x = (df1 * f) / (df1 * f + df2);
  const central = cached((j) => incompleteBeta(x, df1 / 2 + j, df2 / 2));
  return (noncentrality) => {
    const half = noncentrality / 2;
    let weight = Math.exp(-half);
    let sum = 0;
    for (let j = 0; j < half || weight > negligible; j++) {
      sum += weight * central(j);
      weight *= half / (j + 1);
    }
    return sum;
  };
}

/** Beyond these noncentralities the first weight of a series is 0. */
const maxNoncentralityT = 37;
const maxNoncentralityF = 1400;

/** Returns the point between two ends at which a falling probability is `share`, or null if it is not reached. */
function reached(probability: (at: number) => number, share: number, low: number, high: number): number | null {
  return probability(high) > share ? null : bisect(low, high, (at) => probability(at) < share, halvings);
}

/** Returns both ends, or null if one of them is too far out to compute it. */
const between = (low: number | null, high: number | null): Interval | null =>
  low === null || high === null ? null : { low, high };

/** Returns the 95 % interval of the noncentrality of a t, or null if t or an end is too far out to compute it. */
export function noncentralityOfT(t: number, df: number): Interval | null {
  if (Math.abs(t) > maxNoncentralityT / 2) return null;
  const below = noncentralT(t, df);
  const at = (share: number) =>
    below(-maxNoncentralityT) < share ? null : reached(below, share, -maxNoncentralityT, maxNoncentralityT);
  return between(at((1 + confidence) / 2), at((1 - confidence) / 2));
}

/**
 * Returns the 90 % interval of the noncentrality λ of an F, at least 0, or null if F or an end is too large to compute
 * it.
 */
export function noncentralityOfF(f: number, df1: number, df2: number): Interval | null {
  if (f * df1 > maxNoncentralityF / 2) return null;
  const below = noncentralF(f, df1, df2);
  const at = (share: number) => (below(0) < share ? 0 : reached(below, share, 0, maxNoncentralityF));
  return between(at((1 + shareConfidence) / 2), at((1 - shareConfidence) / 2));
}
