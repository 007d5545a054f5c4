import { fTail, noncentralityOfF } from './noncentral';
import { type Interval, meanOf, sumOf } from './summaries';

export interface Effect {
  /** null if there is no variance to measure the effect with; so are the values that depend on it. */
  readonly f: number | null;
  readonly df: readonly [number, number];
  readonly p: number | null;
  /** ε of Greenhouse and Geisser and the p with degrees of freedom times it; null for effects between participants. */
  readonly epsilon: number | null;
  readonly correctedP: number | null;
  /** Partial η²: the share of the variance that other effects do not explain. */
  readonly partialEtaSquared: number | null;
  /** The 90 % interval, as is usual for a one-sided share; null also if F is too large to compute it. */
  readonly interval: Interval | null;
}

/** The effects in an analysis of variance of one measure. */
export interface VarianceAnalysis {
  /** The number of participants. */
  readonly n: number;
  /** The effect of the conditions that each participant met; null: there was one. */
  readonly within: Effect | null;
  /** The effect of the cohorts; null: there is one. */
  readonly between: Effect | null;
  readonly interaction: Effect | null;
}

/** Variance this small relative to the values is rounding. */
const constantBelow = 1e-20;

interface Squares {
  readonly effect: number;
  readonly error: number;
  readonly df: readonly [number, number];
  /** ε; null: it does not apply. */
  readonly epsilon: number | null;
  /** The magnitude of all values, for the test of rounding. */
  readonly scale: number;
}

function effectOf({ effect, error, df, epsilon, scale }: Squares): Effect {
  const none = { f: null, p: null, correctedP: null, partialEtaSquared: null, interval: null };
  if (df[1] < 1 || error <= constantBelow * scale) return { ...none, df, epsilon: null };
  const f = effect / df[0] / (error / df[1]);
  const noncentrality = noncentralityOfF(f, df[0], df[1]);
  const share = (lambda: number) => lambda / (lambda + df[0] + df[1] + 1);
  return {
    f,
    df,
    p: fTail(f, df[0], df[1]),
    epsilon,
    correctedP: epsilon === null ? null : fTail(f, epsilon * df[0], epsilon * df[1]),
    partialEtaSquared: effect / (effect + error),
    interval: noncentrality && { low: share(noncentrality.low), high: share(noncentrality.high) },
  };
}

/** Returns Helmert's orthonormal contrasts of k values. */
function contrasts(count: number): readonly (readonly number[])[] {
  return Array.from({ length: count - 1 }, (_, index) => {
    const before = index + 1;
    const length = Math.sqrt(before * (before + 1));
    return Array.from({ length: count }, (_, at) => (at < before ? 1 / length : at === before ? -before / length : 0));
  });
}

const dotOf = (a: readonly number[], b: readonly number[]) =>
  sumOf(a.map((value, index) => value * (b[index] as number)));

/** Returns the squares of one contrast: of its mean, between cohorts, and the residuals within them. */
function squaresOf(cohorts: readonly (readonly number[])[]) {
  const means = cohorts.map(meanOf);
  const weighted = meanOf(cohorts.flat());
  // Cohorts have equal weights regardless of their size (type III).
  const unweighted = meanOf(means);
  const inverse = sumOf(cohorts.map(({ length }) => 1 / length)) / cohorts.length ** 2;
  return {
    mean: unweighted ** 2 / inverse,
    between: sumOf(cohorts.map(({ length }, index) => length * ((means[index] as number) - weighted) ** 2)),
    residuals: cohorts.flatMap((values, index) => values.map((value) => value - (means[index] as number))),
  };
}

/**
 * Returns ε of the covariances of the contrasts: 1 if all differences of conditions have equal variance, at least 1 /
 * (k − 1).
 */
function greenhouseGeisser(residuals: readonly (readonly number[])[]): number {
  const covariance = residuals.map((a) => residuals.map((b) => dotOf(a, b)));
  const trace = sumOf(covariance.map((row, index) => row[index] as number));
  const squares = sumOf(covariance.flat().map((value) => value * value));
  return trace ** 2 / (residuals.length * squares);
}

/**
 * Analyses the variance of `cohorts[c][p][k]`, the values of participant p of cohort c under condition k: repeated
 * measures with one cohort, one-way with one condition, otherwise mixed. As in SPSS and R's car of type III, cohorts
 * have equal weights. Throws if a cohort is empty or values are missing.
 */
export function varianceAnalysis(cohorts: readonly (readonly (readonly number[])[])[]): VarianceAnalysis {
  const conditions = cohorts[0]?.[0]?.length ?? 0;
  const participants = cohorts.flat();
  if (conditions === 0 || cohorts.some(({ length }) => length === 0)) throw new Error('a cohort has no participants');
  if (participants.some(({ length }) => length !== conditions)) throw new Error('a participant lacks a condition');
  const n = participants.length;
  const groups = cohorts.length;
  const values = participants.flat();
  const scale = dotOf(values, values);

  const size = Math.sqrt(conditions);
  const sums = squaresOf(cohorts.map((members) => members.map((values) => meanOf(values) * size)));
  const between =
    groups < 2
      ? null
      : effectOf({
          effect: sums.between,
          error: dotOf(sums.residuals, sums.residuals),
          df: [groups - 1, n - groups],
          epsilon: null,
          scale,
        });
  if (conditions < 2) return { n, within: null, between, interaction: null };

  const parts = contrasts(conditions).map((contrast) =>
    squaresOf(cohorts.map((members) => members.map((values) => dotOf(values, contrast)))),
  );
  const residuals = parts.map((part) => part.residuals);
  const error = sumOf(residuals.map((one) => dotOf(one, one)));
  const epsilon = error <= constantBelow * scale ? null : greenhouseGeisser(residuals);
  const effect = (squares: (part: (typeof parts)[number]) => number, df: number) =>
    effectOf({
      effect: sumOf(parts.map(squares)),
      error,
      df: [df * (conditions - 1), (n - groups) * (conditions - 1)],
      epsilon,
      scale,
    });
  return {
    n,
    within: effect(({ mean }) => mean, 1),
    between,
    interaction: groups < 2 ? null : effect((part) => part.between, groups - 1),
  };
}
