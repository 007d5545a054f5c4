import { createNormalRandom } from 'threepoint/math';
import { rankSumPs, standardError } from './between-tests';
import { cached } from './distributions';
import { signedRankP } from './paired-tests';
import { ranksOf } from './ranks';
import { criticalT, deviationOf, meanOf, sumOf, twoSidedP } from './summaries';

/** A planned study of two conditions or two cohorts. */
export interface PlannedTest {
  /** paired: all participants meet both conditions; between: two cohorts of n each. */
  readonly design: 'paired' | 'between';
  /**
   * The true difference: paired in standard deviations of the differences (d_z), between in those of the values (d_s).
   */
  readonly effect: number;
  /**
   * The margin of a paired test of equivalence, in standard deviations of the differences; absent: differences are
   * tested.
   */
  readonly margin?: number;
  /** The significance level: two-sided, or of each of the two one-sided tests of equivalence. */
  readonly alpha: number;
}

export interface Simulation {
  readonly seed: number;
  /** The number of simulated studies for each number of participants. */
  readonly studies: number;
}

/** The share of simulated studies that find the effect, or the equivalence. */
export interface Power {
  /** The power of the t-test, or of the two one-sided t-tests of equivalence. */
  readonly t: number;
  /** The power of Wilcoxon's tests: signed ranks for paired designs, rank sums between cohorts; null: equivalence. */
  readonly wilcoxon: number | null;
}

/** Whether one simulated study finds the effect, by either test. */
interface Finding {
  readonly t: boolean;
  readonly wilcoxon: boolean | null;
}

/** Drawn values are not rounded, since the p of a statistic holds without ties. */
const untied = 0;

function pairedStudy({ effect, alpha }: PlannedTest, n: number, normal: () => number): () => Finding {
  const critical = criticalT(1 - alpha, n - 1);
  const pOf = cached((v) => signedRankP(v, n));
  return () => {
    const differences = Array.from({ length: n }, () => effect + normal());
    const t = (meanOf(differences) / deviationOf(differences)) * Math.sqrt(n);
    const { ranks } = ranksOf(differences.map(Math.abs), untied);
    const v = ranks.reduce((sum, rank, index) => sum + ((differences[index] as number) > 0 ? rank : 0), 0);
    return { t: Math.abs(t) >= critical, wilcoxon: pOf(v) <= alpha };
  };
}

function equivalenceStudy(
  margin: number,
  { effect, alpha }: PlannedTest,
  n: number,
  normal: () => number,
): () => Finding {
  const critical = criticalT(1 - 2 * alpha, n - 1);
  return () => {
    const differences = Array.from({ length: n }, () => effect + normal());
    const t = ((margin - Math.abs(meanOf(differences))) / deviationOf(differences)) * Math.sqrt(n);
    return { t: t >= critical, wilcoxon: null };
  };
}

function betweenStudy({ effect, alpha }: PlannedTest, n: number, normal: () => number): () => Finding {
  const pOf = cached(rankSumPs(n, n));
  return () => {
    const first = Array.from({ length: n }, () => effect + normal());
    const second = Array.from({ length: n }, normal);
    const { error, df } = standardError([deviationOf(first) ** 2, deviationOf(second) ** 2], [n, n]);
    const t = (meanOf(first) - meanOf(second)) / error;
    const { ranks } = ranksOf([...first, ...second], untied);
    const w = sumOf(ranks.slice(0, n)) - (n * (n + 1)) / 2;
    return { t: twoSidedP(t, df) <= alpha, wilcoxon: pOf(w) <= alpha };
  };
}

function studyOf(planned: PlannedTest, n: number, normal: () => number): () => Finding {
  if (planned.margin !== undefined) return equivalenceStudy(planned.margin, planned, n, normal);
  return planned.design === 'paired' ? pairedStudy(planned, n, normal) : betweenStudy(planned, n, normal);
}

/**
 * Returns the power of a study of n participants (between: n in each cohort, at least 2) with normally distributed
 * values. The same seed gives the same power.
 */
export function simulatedPower(planned: PlannedTest, n: number, { seed, studies }: Simulation): Power {
  const normal = createNormalRandom(seed + 7919 * n);
  const study = studyOf(planned, n, normal);
  const findings = Array.from({ length: studies }, study);
  const share = (test: 't' | 'wilcoxon') => findings.filter((finding) => finding[test]).length / studies;
  return { t: share('t'), wilcoxon: planned.margin === undefined ? share('wilcoxon') : null };
}

/** A row of the table from which a number of participants is chosen. */
export interface PowerRow extends Power {
  readonly n: number;
}

/** The most participants (between: in each cohort) of a simulated study. */
export const maxSimulated = 1000;

/**
 * Returns the power of growing studies, from few participants to the first at which all tests reach `power`, or to
 * `maxSimulated`. Beyond a hundred, steps are a twentieth of the number.
 */
export function powerTable(planned: PlannedTest, power: number, simulation: Simulation): readonly PowerRow[] {
  const rows: PowerRow[] = [];
  for (let n = 4; n <= maxSimulated; n += n < 100 ? 1 : Math.floor(n / 20)) {
    const row = { n, ...simulatedPower(planned, n, simulation) };
    rows.push(row);
    if (Math.min(row.t, row.wilcoxon ?? 1) >= power) break;
  }
  return rows;
}
