import type { Comparison } from '../../model/results/compare-conditions';
import { type TableHead, type TableRow, tableNode } from '../table';
import { fixed, meanCell, measureCell, pText } from './result-cells';
import type { ShownComparison } from './shown-results';

const significance = 0.05;

/** The headings of tests of conditions, and of tests between cohorts. */
const testHeads = {
  paired: {
    n: 'Pairs',
    t: 'Paired t-test',
    d: ['d_z', "Cohen's d of the differences, with its 95 % interval"],
    ranks: ['V', "Wilcoxon's signed ranks"],
  },
  between: {
    n: 'In the first and in the second cohort',
    t: "Welch's t-test",
    d: ['d_s', "Cohen's d in pooled standard deviations, with its 95 % interval"],
    ranks: ['W', "Wilcoxon's rank sums (Mann and Whitney's U)"],
  },
} as const;

function headsOf({ labels, between }: ShownComparison): readonly TableHead[] {
  const heads = between ? testHeads.between : testHeads.paired;
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

function rowOf({ results, between }: ShownComparison, one: Comparison, tagged: boolean): TableRow {
  const { first, second, values, test, ranks, holmP, ranksHolmP } = one;
  const significant = (holmP ?? 1) < significance;
  return {
    look: significant ? 'significant' : '',
    cells: [
      measureCell(results, one, tagged),
      between ? `${values.first.length}, ${values.second.length}` : String(values.first.length),
      meanCell(first?.mean, first?.interval, 2),
      meanCell(second?.mean, second?.interval, 2),
      meanCell(test?.meanDifference, test?.interval, 2),
      fixed(test?.t, 3),
      fixed(test?.df, between ? 1 : 0),
      pText(test?.p),
      meanCell(test?.d, test?.dInterval, 2),
      fixed(ranks?.statistic, 1),
      meanCell(ranks?.effect, ranks?.effectInterval, 2),
      pText(ranks?.p),
      pText(ranksHolmP),
      `${pText(holmP)}${significant ? ' *' : ''}`,
    ],
  };
}

/** Returns a table of comparisons. Planned ones are marked if the table also has others. */
export const comparedTable = (
  compared: ShownComparison,
  caption: string,
  comparisons: readonly Comparison[],
): HTMLElement =>
  tableNode(
    caption,
    headsOf(compared),
    comparisons.map((one) => rowOf(compared, one, comparisons !== compared.planned)),
    'dense',
  );
