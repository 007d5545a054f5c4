import type { Comparison } from '../../model/results/compare-conditions';
import { type Column, numberColumn, Table, textColumn } from '../table';
import { fixed, meanCell, measureCell, pText } from './result-cells';
import type { ShownComparison } from './shown-results';

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

const isSignificant = ({ holmP }: Comparison) => (holmP ?? 1) < 0.05;
const holmText = (one: Comparison) => `${pText(one.holmP)}${isSignificant(one) ? ' *' : ''}`;

/** Returns the columns of a table of comparisons; `tagged`: planned ones are marked. */
function columnsOf({ results, labels, between }: ShownComparison, tagged: boolean): readonly Column<Comparison>[] {
  const heads = between ? testHeads.between : testHeads.paired;
  const [d, dTitle] = heads.d;
  const [ranks, ranksTitle] = heads.ranks;
  const effectTitle = `Rank-biserial correlation, the effect size of ${ranks}, with its 95 % interval`;
  const nText = ({ first, second }: Comparison['values']) =>
    between ? `${first.length}, ${second.length}` : first.length;
  return [
    textColumn('Measure', (one) => measureCell(results, one, tagged)),
    numberColumn('n', ({ values }) => nText(values), heads.n),
    numberColumn(labels.first, ({ first }) => meanCell(first?.mean, first?.interval, 2)),
    numberColumn(labels.second, ({ second }) => meanCell(second?.mean, second?.interval, 2)),
    numberColumn('difference', ({ test }) => meanCell(test?.meanDifference, test?.interval, 2)),
    numberColumn('t', ({ test }) => fixed(test?.t, 3), heads.t),
    numberColumn('df', ({ test }) => fixed(test?.df, between ? 1 : 0)),
    numberColumn('p', ({ test }) => pText(test?.p), 'Two-sided, of the t-test'),
    numberColumn(d, ({ test }) => meanCell(test?.d, test?.dInterval, 2), dTitle),
    numberColumn(ranks, (one) => fixed(one.ranks?.statistic, 1), ranksTitle),
    numberColumn('r', (one) => meanCell(one.ranks?.effect, one.ranks?.effectInterval, 2), effectTitle),
    numberColumn(`p (${ranks})`, (one) => pText(one.ranks?.p), 'Two-sided, of Wilcoxon’s test'),
    numberColumn(`Holm p (${ranks})`, (one) => pText(one.ranksHolmP), 'Wilcoxon’s p adjusted over the family'),
    numberColumn('Holm p', holmText, 'The t-test’s p adjusted over the family'),
  ];
}

/** Returns a table of comparisons. Planned ones are marked if the table also has others. */
export const comparedTable = (compared: ShownComparison, caption: string, comparisons: readonly Comparison[]) => (
  <Table
    caption={caption}
    columns={columnsOf(compared, comparisons !== compared.planned)}
    rows={comparisons}
    look={(one) => (isSignificant(one) ? 'significant' : '')}
    dense
  />
);
