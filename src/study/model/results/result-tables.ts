import type { Effect, VarianceAnalysis } from '../../statistics/analysis-of-variance';
import type { WelchTest } from '../../statistics/between-tests';
import type { SignedRankTest } from '../../statistics/paired-tests';
import type { Interval, MeanSummary } from '../../statistics/summaries';
import { boolean, type Column, number, type Table, text } from '../tables/tidy-csv';
import type { OverallComparison } from './compare-all';
import type { Comparison } from './compare-conditions';
import type { FrameTimeRow } from './frame-times';
import type { Measured } from './measures';
import { checkedPaperRows } from './paper-tables';

/** The facts that tables of results state next to their figures. */
export interface TableFacts {
  /** planned: p is adjusted over the measures that the plan names only. */
  readonly family: 'planned' | 'explored';
  readonly simulated: boolean;
  /** Returns the subject of a question in a word or two; empty: none. */
  readonly aboutOf: (one: Measured) => string;
  readonly isPlanned: (one: Measured) => boolean;
}

const simulatedColumn = boolean(
  'simulated',
  'records: simulated',
  'TRUE: made by a program. It says nothing about people.',
);
const ids = 'small letters, digits, hyphens';
/** Values in [0, 1]: p, ε, shares of variance. */
export const share = '0 to 1';
const correlation = '-1 to 1';

/** The first columns of every table of compared measures. */
export const measureColumns: readonly Column[] = [
  simulatedColumn,
  text(
    'of',
    'an id, or task/questionnaire/id',
    'answers, scales or trials',
    'Question, scale, or task whose scores are compared.',
  ),
  text('about', 'any text', 'questions.csv: about, scale-definitions.csv: label', 'Subject; empty for scores.'),
  text('unit', 'answer, points, percent', 'what is compared', 'answer: in the unit of the question’s scale.'),
  boolean(
    'planned',
    'planned.csv',
    'TRUE: named by the plan; tables of results that begin with planned adjust p over these only. FALSE: exploratory.',
  ),
];

/** Returns the first cells of every row. */
export const measureCells = (one: Measured, { simulated, aboutOf, isPlanned }: TableFacts) => ({
  simulated,
  of: one.of,
  about: aboutOf(one),
  unit: one.unit,
  planned: isPlanned(one),
});

/** Returns the columns of one side's mean and interval. */
export const meanColumns = (side: 'first' | 'second', what: string, source: (figure: string) => string) => [
  number(`mean_${side}`, '', 'any', source('mean'), `Mean ${what}.`),
  number(`low_${side}`, '', 'any', source('interval'), 'Lower end of its 95 % confidence interval.'),
  number(`high_${side}`, '', 'any', source('interval'), 'Upper end.'),
];

/** Returns the cells of one side. */
export const meanCells = (side: 'first' | 'second', summary: MeanSummary | null) => ({
  [`mean_${side}`]: summary?.mean ?? null,
  ...endCells(side, summary?.interval),
});

/** Returns the cells of the ends of an interval. */
const endCells = (name: string, ends: Interval | null | undefined) => ({
  [`low_${name}`]: ends?.low ?? null,
  [`high_${name}`]: ends?.high ?? null,
});

/** Returns the cells of a t-test and its effect size, which is named `ds` or `dz`. */
export const testCells = (
  test: Pick<WelchTest, 'meanDifference' | 'interval' | 't' | 'df' | 'p'> | null | undefined,
  effect: 'ds' | 'dz',
  size: number | null | undefined,
  ends: Interval | null | undefined,
) => ({
  difference: test?.meanDifference ?? null,
  ...endCells('difference', test?.interval),
  t: test?.t ?? null,
  df: test?.df ?? null,
  p: test?.p ?? null,
  [effect]: size ?? null,
  ...endCells(effect, ends),
});

/** Returns the cells of a rank-biserial correlation. */
export const biserialCells = (ranks: Pick<SignedRankTest, 'effect' | 'effectInterval'> | null | undefined) => ({
  rank_biserial: ranks?.effect ?? null,
  ...endCells('rank_biserial', ranks?.effectInterval),
});

/** Returns the columns of the ends of an effect's interval. */
export const endColumns = (name: string, method: string, none: string) => [
  number(`low_${name}`, '', 'any', `computed: ${method}`, 'Lower end of its 95 % confidence interval.'),
  number(`high_${name}`, '', 'any', `computed: ${method}`, `Upper end; both empty: ${none}.`),
];

/** Returns the columns of an interval by the noncentral t. */
export const noncentralColumns = (name: string) =>
  endColumns(name, 'noncentral t', 'nothing varies, or t is too far out');

/** The columns of the interval of a rank-biserial correlation. */
export const biserialColumns = [
  number('rank_biserial', '', correlation, 'computed: (ranks for − ranks against) / all ranks', 'Its effect size.'),
  ...endColumns(
    'rank_biserial',
    "Fisher's z with the standard error of the ranks where nothing differs",
    'all ranks are on one side',
  ),
];

/** Describes the rows over which p is adjusted. */
export const familyText = ({ family }: Pick<TableFacts, 'family'>, alike: string) =>
  `computed: Holm over the rows of this table with the same ${alike}${family === 'planned' ? '' : ' and unit'}`;

const t = 'computed: paired t-test';
const wilcoxon = "computed: Wilcoxon's signed-rank test, as R's wilcox.test up to 4.5, ties within rounding";
const underBoth = (figure: string) => `computed: the ${figure} of what each had under both conditions`;

function comparisonColumns(facts: TableFacts): readonly Column[] {
  const family = familyText(facts, 'two conditions');
  return [
    ...measureColumns,
    text('first', ids, 'plan.json: conditions', 'Condition from which the other is subtracted.'),
    text('second', ids, 'plan.json: conditions', 'Condition that is subtracted.'),
    number('n', '', '0, 1, 2 …', 'computed', 'Pairs: participants, or groups where a group has one score.'),
    ...meanColumns('first', 'under the first condition', underBoth),
    ...meanColumns('second', 'under the second condition', underBoth),
    number('difference', '', 'any', t, 'Mean of first − second.'),
    number('low_difference', '', 'any', t, 'Lower end of its 95 % confidence interval.'),
    number('high_difference', '', 'any', t, 'Upper end.'),
    number('t', '', 'any', t, 'Empty: the differences do not vary.'),
    number('df', '', '0, 1, 2 …', t, 'Its degrees of freedom.'),
    number('p', '', share, t, 'Its two-sided p.'),
    number('p_holm', '', share, family, 'p adjusted.'),
    number('dz', '', 'any', 'computed: t / √n', "Cohen's d_z: mean difference in its standard deviations."),
    ...noncentralColumns('dz'),
    number('v', '', '0 and more', wilcoxon, 'Sum of the positive ranks.'),
    number('p_wilcoxon', '', share, wilcoxon, 'Its two-sided p.'),
    number('p_wilcoxon_holm', '', share, family, 'p_wilcoxon adjusted.'),
    text('method_wilcoxon', 'exact, normal', wilcoxon, 'normal: approximation for ties, zeros and 50 pairs or more.'),
    ...biserialColumns,
  ];
}

/** Comparisons that belong together. */
export interface ComparedPair {
  /** The ids: first − second. */
  readonly conditions: readonly [string, string];
  readonly comparisons: readonly Comparison[];
}

const comparisonCells = (one: Comparison) => ({
  n: one.pairs.length,
  ...meanCells('first', one.first),
  ...meanCells('second', one.second),
  ...testCells(one.test, 'dz', one.test?.dz, one.test?.dzInterval),
  p_holm: one.holmP,
  v: one.signedRank?.v ?? null,
  p_wilcoxon: one.signedRank?.p ?? null,
  p_wilcoxon_holm: one.ranksHolmP,
  method_wilcoxon: one.signedRank?.method ?? '',
  ...biserialCells(one.signedRank),
});

/** Returns comparisons of conditions as a tidy table in full precision. */
export const comparisonTable = (name: string, pairs: readonly ComparedPair[], facts: TableFacts): Table => ({
  name,
  columns: comparisonColumns(facts),
  rows: pairs.flatMap(({ conditions: [first, second], comparisons }) =>
    comparisons.map((one) => ({ ...measureCells(one, facts), first, second, ...comparisonCells(one) })),
  ),
});

const fTest = 'computed: analysis of variance, type III squares';
const ranks = "computed: Friedman's test; with one condition Kruskal and Wallis's";
const familyOfAll = 'computed: Holm over all measures of this table';

const overallColumns: readonly Column[] = [
  ...measureColumns,
  text(
    'effect',
    'conditions, cohorts, conditions and cohorts',
    'plan.json: conditions, cohorts',
    'Effect within participants, between them, and their interaction.',
  ),
  number('n', '', '0, 1, 2 …', 'computed', 'Participants (or groups) whose values are complete.'),
  number('f', '', '0 and more', fTest, 'Empty: nothing spreads.'),
  number('df1', '', '1, 2, 3 …', fTest, 'Degrees of freedom of the effect.'),
  number('df2', '', '0, 1, 2 …', fTest, 'Degrees of freedom of the error.'),
  number('p', '', share, fTest, 'Assumes equal variances of the differences of all conditions.'),
  number('epsilon', '', share, 'computed: Greenhouse and Geisser', 'Empty for cohorts.'),
  number(
    'p_corrected',
    '',
    share,
    'computed: F with both degrees of freedom times epsilon',
    'The corrected p, which is to be reported.',
  ),
  number('partial_eta_squared', '', share, 'computed: squares of the effect / (these + error)', 'Its effect size.'),
  number('low_eta', '', share, 'computed: noncentral F', 'Lower end of its 90 % confidence interval.'),
  number('high_eta', '', share, 'computed: noncentral F', 'Upper end; empty: F is too large.'),
  number('p_holm', '', share, familyOfAll, 'p_corrected (of cohorts: p) adjusted, in the first row of a measure.'),
  number('chi_squared', '', '0 and more', ranks, 'In the first row of a measure; empty: nothing differs.'),
  number('df_ranks', '', '1, 2, 3 …', ranks, 'Its degrees of freedom.'),
  number('p_ranks', '', share, ranks, 'Its p.'),
  number('effect_ranks', '', share, ranks, "Its effect size: Kendall's W, or of cohorts H / (n − 1)."),
  number('p_ranks_holm', '', share, familyOfAll, 'p_ranks adjusted.'),
];

const effectCells = (effect: Effect) => ({
  f: effect.f,
  df1: effect.df[0],
  df2: effect.df[1],
  p: effect.p,
  epsilon: effect.epsilon,
  p_corrected: effect.correctedP,
  partial_eta_squared: effect.partialEtaSquared,
  ...endCells('eta', effect.interval),
});

/** Returns the analysed effects by name. */
export const effectsOf = (variance: VarianceAnalysis | null): readonly (readonly [string, Effect])[] =>
  (
    [
      ['conditions', variance?.within ?? null],
      ['cohorts', variance?.between ?? null],
      ['conditions and cohorts', variance?.interaction ?? null],
    ] as const
  ).flatMap(([name, effect]) => (effect ? [[name, effect] as const] : []));

/** Returns the cells of a whole measure, which are in the row of its first effect; null: another row. */
const wholeCells = (one: OverallComparison | null) => ({
  p_holm: one?.holmP ?? null,
  chi_squared: one?.ranks?.chiSquared ?? null,
  df_ranks: one?.ranks?.df ?? null,
  p_ranks: one?.ranks?.p ?? null,
  effect_ranks: one?.ranks?.effect ?? null,
  p_ranks_holm: one?.ranksHolmP ?? null,
});

/** Returns the analyses of all conditions and cohorts as a tidy table with a row for each effect. */
export const overallTable = (name: string, comparisons: readonly OverallComparison[], facts: TableFacts): Table => ({
  name,
  columns: overallColumns,
  rows: comparisons.flatMap((one) =>
    effectsOf(one.variance).map(([effect, found], index) => ({
      ...measureCells(one, facts),
      effect,
      n: one.n,
      ...effectCells(found),
      ...wholeCells(index === 0 ? one : null),
    })),
  ),
});

/** Returns frame times as a tidy table. */
export const frameTimeTable = (rows: readonly FrameTimeRow[], { simulated }: Pick<TableFacts, 'simulated'>): Table => ({
  name: 'frame-times',
  columns: [
    simulatedColumn,
    text('task', ids, 'frame-times.csv', 'Id of the task.'),
    text('condition', ids, 'frame-times.csv', 'Id of the condition.'),
    text('cohort', ids, 'participants.csv', 'Id of the cohort; empty: the study has none.'),
    text('stage', 'small letters, hyphens', 'frame-times.csv', 'Stage of the frame; "frame" is all of its work.'),
    number('trials', '', '1, 2, 3 …', 'computed from frame-times.csv', 'Trials that count.'),
    number('frames', '', '0, 1, 2 …', 'computed from frame-times.csv: count', 'Frames measured in them.'),
    number('min', 'ms', '0 and more', 'computed from frame-times.csv: min', 'Shortest.'),
    number('max', 'ms', '0 and more', 'computed from frame-times.csv: max', 'Longest.'),
    number('mean', 'ms', '0 and more', 'computed from frame-times.csv: mean, count', 'Mean over all frames.'),
    number(
      'worst_p95',
      'ms',
      '0 and more',
      'computed from frame-times.csv: p95',
      "Largest of the trials' 95th percentiles.",
    ),
    number('missed', '', '0, 1, 2 …', 'computed from trials.csv: missed_frames', 'Frames shown late, in any stage.'),
  ],
  rows: rows.map(({ minMs, maxMs, meanMs, worstP95Ms, ...rest }) => ({
    simulated,
    ...rest,
    min: minMs,
    max: maxMs,
    mean: meanMs,
    worst_p95: worstP95Ms,
  })),
});

const printed = "the paper's tables 9 and 10";

/** Returns the paper's tables 9 and 10 with the values computed from their t. */
export const paperTable = (): Table => ({
  name: 'paper-check',
  columns: [
    text('question', 'Q1 to Q12', printed, 'Id.'),
    number('ours', '', '1 to 5', printed, 'Mean under the method of the paper.'),
    number('ik', '', '1 to 5', printed, 'Mean under inverse kinematics.'),
    number('t', '', 'any', printed, 'Paired t-test.'),
    number('printed_p', '', share, printed, 'Its p.'),
    number('p', '', share, 'computed from t', 'Two-sided p that follows from t with 14 degrees of freedom.'),
    boolean('follows', 'computed from t', 'Whether the printed p follows from the printed t.'),
    number('p_holm', '', share, 'computed: Holm over all twelve', 'The paper does not correct.'),
    number('dz', '', 'any', 'computed: t / √15', "Cohen's d_z."),
  ],
  rows: checkedPaperRows().map(({ question, ours, ik, t, printedP, p, follows, holmP, dz }) => ({
    question,
    ours,
    ik,
    t,
    printed_p: printedP,
    p,
    follows,
    p_holm: holmP,
    dz,
  })),
});
