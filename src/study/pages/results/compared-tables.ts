import type { CohortComparison } from '../../model/results/compare-cohorts';
import type { Comparison } from '../../model/results/compare-conditions';
import type { Measured } from '../../model/results/measures';
import type { Interval } from '../../statistics/summaries';
import { type TableHead, type TableRow, tableNode } from '../table';
import { fixed, meanCell, measureCell, none, pText } from './result-cells';
import type { Compared, ShownResults } from './shown-results';

const significance = 0.05;

/** The test results in a row of a table, of pairs or of cohorts. */
interface Tested {
  readonly n: string;
  readonly difference: number | undefined;
  readonly interval: Interval | null | undefined;
  readonly t: number | null | undefined;
  readonly df: string;
  readonly p: number | null | undefined;
  readonly effect: number | null | undefined;
  readonly effectInterval: Interval | null | undefined;
  readonly ranks: string;
  readonly byRanks: {
    readonly p: number | null;
    readonly effect: number | null;
    readonly effectInterval: Interval | null;
  } | null;
}

/** Paired tests; V is the sum of positive ranks. */
export const testedPairs = ({ pairs, test, signedRank }: Comparison): Tested => ({
  n: String(pairs.length),
  difference: test?.meanDifference,
  interval: test?.interval,
  t: test?.t,
  df: test ? String(test.df) : none,
  p: test?.p,
  effect: test?.dz,
  effectInterval: test?.dzInterval,
  ranks: fixed(signedRank?.v, 1),
  byRanks: signedRank,
});

/** Tests between cohorts; W counts the pairs in which the first is larger. */
export const testedCohorts = ({ first, second, test, rankSum }: CohortComparison): Tested => ({
  n: `${first?.n ?? 0}, ${second?.n ?? 0}`,
  difference: test?.meanDifference,
  interval: test?.interval,
  t: test?.t,
  df: fixed(test?.df, 1),
  p: test?.p,
  effect: test?.ds,
  effectInterval: test?.dsInterval,
  ranks: fixed(rankSum?.w, 1),
  byRanks: rankSum,
});

type Two = Measured & Pick<Comparison, 'first' | 'second' | 'holmP' | 'ranksHolmP'>;

/** The kind of test of two sides and the headings of its columns. */
export interface Testing<One extends Two> {
  readonly tested: (one: One) => Tested;
  readonly heads: {
    readonly n: string;
    readonly t: string;
    readonly d: readonly [string, string];
    readonly ranks: readonly [string, string];
  };
}

export const pairTesting: Testing<Comparison> = {
  tested: testedPairs,
  heads: {
    n: 'Pairs',
    t: 'Paired t-test',
    d: ['d_z', "Cohen's d of the differences, with its 95 % interval"],
    ranks: ['V', "Wilcoxon's signed ranks"],
  },
};

export const cohortTesting: Testing<CohortComparison> = {
  tested: testedCohorts,
  heads: {
    n: 'In the first and in the second cohort',
    t: "Welch's t-test",
    d: ['d_s', "Cohen's d in pooled standard deviations, with its 95 % interval"],
    ranks: ['W', "Wilcoxon's rank sums (Mann and Whitney's U)"],
  },
};

function headsOf<One extends Two>({ heads }: Testing<One>, { labels }: Compared<One>): readonly TableHead[] {
  const [d, dTitle] = heads.d;
  const [ranks, ranksTitle] = heads.ranks;
  return [
    { text: 'Measure' },
    { text: 'n', title: heads.n, numeric: true },
    { text: labels.first, numeric: true },
    { text: labels.second, numeric: true },
    { text: 'difference', numeric: true },
    { text: 't', title: heads.t, numeric: true },
    { text: 'df', numeric: true },
    { text: 'p', title: 'Two-sided, of the t-test', numeric: true },
    { text: d, title: dTitle, numeric: true },
    { text: ranks, title: ranksTitle, numeric: true },
    {
      text: 'r',
      title: `Rank-biserial correlation, the effect size of ${ranks}, with its 95 % interval`,
      numeric: true,
    },
    { text: `p (${ranks})`, title: 'Two-sided, of Wilcoxon’s test', numeric: true },
    { text: `Holm p (${ranks})`, title: 'Wilcoxon’s p adjusted over the family', numeric: true },
    { text: 'Holm p', title: 'The t-test’s p adjusted over the family', numeric: true },
  ];
}

function rowOf<One extends Two>(results: ShownResults, testing: Testing<One>, one: One, tagged: boolean): TableRow {
  const { n, difference, interval, t, df, p, effect, effectInterval, ranks, byRanks } = testing.tested(one);
  const significant = (one.holmP ?? 1) < significance;
  return {
    look: significant ? 'significant' : '',
    cells: [
      measureCell(results, one, tagged),
      n,
      meanCell(one.first?.mean, one.first?.interval, 2),
      meanCell(one.second?.mean, one.second?.interval, 2),
      meanCell(difference, interval, 2),
      fixed(t, 3),
      df,
      pText(p),
      meanCell(effect ?? undefined, effectInterval, 2),
      ranks,
      meanCell(byRanks?.effect ?? undefined, byRanks?.effectInterval, 2),
      pText(byRanks?.p),
      pText(one.ranksHolmP),
      `${pText(one.holmP)}${significant ? ' *' : ''}`,
    ],
  };
}

/** Returns a table of comparisons. Planned ones are marked if the table also has others. */
export const comparedTable = <One extends Two>(
  compared: Compared<One>,
  testing: Testing<One>,
  caption: string,
  comparisons: readonly One[],
): HTMLElement =>
  tableNode(
    caption,
    headsOf(testing, compared),
    comparisons.map((one) => rowOf(compared.results, testing, one, comparisons !== compared.planned)),
    'dense',
  );
