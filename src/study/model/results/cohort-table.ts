import { type Column, number, type Table, text } from '../tables/tidy-csv';
import type { CohortComparison, ComparedCohorts } from './compare-cohorts';
import {
  biserialCells,
  biserialColumns,
  familyText,
  meanCells,
  meanColumns,
  measureCells,
  measureColumns,
  noncentralColumns,
  share,
  type TableFacts,
  testCells,
} from './result-tables';

const ids = 'small letters, digits, hyphens';
const cohorts = 'plan.json: cohorts';
const welch = "computed: Welch's t-test";
const rankSums =
  "computed: Wilcoxon's rank-sum test (Mann and Whitney's), as R's wilcox.test up to 4.5, ties within rounding";
const ofEach = (figure: string) => `computed: the ${figure} of what each of the cohort had`;

function columnsOf(facts: TableFacts): readonly Column[] {
  const family = familyText(facts, 'two cohorts, condition');
  return [
    ...measureColumns,
    text('first', ids, cohorts, 'Cohort from which the other is subtracted.'),
    text('second', ids, cohorts, 'Cohort that is subtracted.'),
    text(
      'condition',
      ids,
      'plan.json: conditions',
      'Condition; empty: the mean of each participant over all conditions.',
    ),
    number('n_first', '', '0, 1, 2 …', 'computed', 'Participants of the first (groups, where a group has one score).'),
    number('n_second', '', '0, 1, 2 …', 'computed', 'Of the second.'),
    ...meanColumns('first', 'of the first cohort', ofEach),
    ...meanColumns('second', 'of the second cohort', ofEach),
    number('difference', '', 'any', welch, 'First − second.'),
    number('low_difference', '', 'any', welch, 'Lower end of its 95 % confidence interval.'),
    number('high_difference', '', 'any', welch, 'Upper end.'),
    number('t', '', 'any', welch, 'Empty: there are too few, or nothing varies.'),
    number('df', '', 'more than 0', welch, 'Its degrees of freedom by Welch and Satterthwaite.'),
    number('p', '', share, welch, 'Its two-sided p.'),
    number('p_holm', '', share, family, 'p adjusted.'),
    number('ds', '', 'any', 'computed: difference / pooled standard deviation', "Cohen's d_s."),
    ...noncentralColumns('ds'),
    number('w', '', '0 and more', rankSums, 'Pairs of both cohorts in which the first is larger; ties count half.'),
    number('p_rank_sum', '', share, rankSums, 'Its two-sided p.'),
    number('p_rank_sum_holm', '', share, family, 'p_rank_sum adjusted.'),
    text('method_rank_sum', 'exact, normal', rankSums, 'normal: approximation for ties and 50 in a cohort or more.'),
    ...biserialColumns,
  ];
}

const cells = ({ first, second, test, rankSum, holmP, ranksHolmP }: CohortComparison) => ({
  n_first: first?.n ?? 0,
  n_second: second?.n ?? 0,
  ...meanCells('first', first),
  ...meanCells('second', second),
  ...testCells(test, 'ds', test?.ds, test?.dsInterval),
  p_holm: holmP,
  w: rankSum?.w ?? null,
  p_rank_sum: rankSum?.p ?? null,
  p_rank_sum_holm: ranksHolmP,
  method_rank_sum: rankSum?.method ?? '',
  ...biserialCells(rankSum),
});

/** Comparisons that belong together. */
export interface ComparedCohortPair {
  readonly compared: ComparedCohorts;
  readonly comparisons: readonly CohortComparison[];
}

/** Returns comparisons of cohorts as a tidy table in full precision. */
export const cohortTable = (name: string, pairs: readonly ComparedCohortPair[], facts: TableFacts): Table => ({
  name,
  columns: columnsOf(facts),
  rows: pairs.flatMap(({ compared: { cohorts: of, conditions }, comparisons }) =>
    comparisons.map((one) => ({
      ...measureCells(one, facts),
      first: of[0],
      second: of[1],
      condition: conditions.length === 1 ? (conditions[0] ?? '') : '',
      ...cells(one),
    })),
  ),
});
