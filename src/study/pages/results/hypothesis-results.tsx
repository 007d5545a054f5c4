import { claimOf } from '../../model/plan/hypotheses';
import type { Comparison } from '../../model/results/compare-conditions';
import { type Column, numberColumn, Table, textColumn } from '../table';
import { fixed, meanCell, none, pText } from './result-cells';
import type { ShownResults } from './shown-results';

const isBelow = (p: number | null) => p !== null && p < 0.05;

/** Returns what the tests of difference and of equivalence show together. */
function findingOf({ holmP, equivalenceHolmP }: Comparison): string {
  const within = isBelow(equivalenceHolmP);
  if (isBelow(holmP)) return within ? 'a difference within the margin' : 'a difference';
  return within ? 'equivalent' : 'undecided';
}

const columnsOf = ({ nameOf }: ShownResults): readonly Column<Comparison>[] => [
  textColumn('Hypothesis', ({ hypothesis }) => hypothesis?.id),
  textColumn('measure', nameOf),
  numberColumn('n', ({ values }) => values.first.length, 'Pairs'),
  numberColumn('margin', ({ hypothesis }) => (hypothesis?.margin === undefined ? none : `±${hypothesis.margin}`)),
  numberColumn(
    'difference',
    ({ test, equivalence }) => meanCell(test?.meanDifference, equivalence?.interval, 2),
    'With its 90 % interval, which lies within the margin where p (equivalence) is below .05',
  ),
  numberColumn('Holm p (difference)', ({ holmP }) => pText(holmP), 'The paired t-test’s, as in the table below'),
  numberColumn('t', ({ equivalence }) => fixed(equivalence?.t, 3), 'The smaller t of two one-sided t-tests'),
  numberColumn('p (equivalence)', ({ equivalence }) => pText(equivalence?.p), 'The larger p of two one-sided t-tests'),
  numberColumn(
    'Holm p (equivalence)',
    ({ equivalenceHolmP }) => pText(equivalenceHolmP),
    'Adjusted over the tests of equivalence in this table',
  ),
  textColumn('finding', findingOf, 'Of both Holm p, at .05'),
];

/** Returns the plan's hypotheses about two conditions with their tests; nothing if it has none about them. */
export function hypothesisResults(results: ShownResults, comparisons: readonly Comparison[]) {
  const tested = comparisons.filter(({ hypothesis }) => hypothesis !== null);
  if (tested.length === 0) return null;
  const { hypotheses = [] } = results.study.plan;
  const stated = hypotheses.filter((one) => tested.some(({ hypothesis }) => hypothesis === one));
  return (
    <>
      <ul>
        {stated.map((one) => (
          <li>{`${one.id}: ${one.text} Claim: ${claimOf(one, results.labelOf)}.`}</li>
        ))}
      </ul>
      <Table
        caption="Hypotheses: tests of difference (paired t-tests) and of equivalence (two one-sided paired t-tests)"
        columns={columnsOf(results)}
        rows={stated.flatMap((one) => tested.filter(({ hypothesis }) => hypothesis === one))}
        dense
      />
    </>
  );
}
