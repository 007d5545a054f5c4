import type { Effect, VarianceAnalysis } from '../statistics/analysis-of-variance';
import type { OverallComparison } from './compare-all';
import type { Comparison } from './compare-conditions';
import type { FrameTimeRow } from './frame-times';
import { checkedPaperRows } from './paper-tables';
import { boolean, type Column, number, type Table, text } from './tidy-csv';

const simulatedColumn = boolean(
  'simulated',
  'records: simulated',
  'TRUE: made by a program. It says nothing about people.',
);
const ids = 'small letters, digits, hyphens';
const share = '0 to 1';
const ofTest = (side: string) => `computed: the ${side} of what each had under both conditions`;
const t = 'computed: paired t-test';
const wilcoxon = "computed: Wilcoxon's signed-rank test, as R's wilcox.test up to 4.5";
const familyOfTwo = 'computed: Holm over the rows of this table with the same two conditions and unit';

const meanColumns = (side: 'first' | 'second') => [
  number(`mean_${side}`, '', 'any', ofTest('mean'), `Mean under the ${side} condition.`),
  number(`low_${side}`, '', 'any', ofTest('interval'), 'Lower end of its 95 % confidence interval.'),
  number(`high_${side}`, '', 'any', ofTest('interval'), 'Upper end.'),
];

const comparisonColumns: readonly Column[] = [
  simulatedColumn,
  text(
    'of',
    'an id, or task/questionnaire/id',
    'answers, scales or trials',
    'Question, scale, or task whose scores are compared.',
  ),
  text(
    'about',
    'any text',
    'questions.csv: about, scale-definitions.csv: label',
    'What it asks about; empty for scores.',
  ),
  text('unit', 'answer, points, percent', 'what is compared', 'answer: as the scale of the question goes.'),
  text('first', ids, 'plan.json: conditions', 'Condition whose values the difference begins with.'),
  text('second', ids, 'plan.json: conditions', 'Condition that is subtracted.'),
  number('n', '', '0, 1, 2 …', 'computed', 'Pairs: participants, or groups where a group has one score.'),
  ...meanColumns('first'),
  ...meanColumns('second'),
  number('difference', '', 'any', t, 'Mean of first − second.'),
  number('low_difference', '', 'any', t, 'Lower end of its 95 % confidence interval.'),
  number('high_difference', '', 'any', t, 'Upper end.'),
  number('t', '', 'any', t, 'Empty: the differences do not vary.'),
  number('df', '', '0, 1, 2 …', t, 'Its degrees of freedom.'),
  number('p', '', share, t, 'Its two-sided p.'),
  number('p_holm', '', share, familyOfTwo, 'p adjusted.'),
  number('dz', '', 'any', 'computed: t / √n', "Cohen's d_z: mean difference in its standard deviations."),
  number('v', '', '0 and more', wilcoxon, 'Sum of the positive ranks.'),
  number('p_wilcoxon', '', share, wilcoxon, 'Its two-sided p.'),
  number('p_wilcoxon_holm', '', share, familyOfTwo, 'p_wilcoxon adjusted.'),
  text('method_wilcoxon', 'exact, normal', wilcoxon, 'normal: approximation for ties, zeros and 50 pairs or more.'),
  number('rank_biserial', '', '-1 to 1', 'computed: (2 v − all ranks) / all ranks', 'Its effect size.'),
];

/** What comparisons are of. */
export interface ComparedFacts {
  /** Ids: first − second. */
  readonly conditions: readonly [string, string];
  readonly simulated: boolean;
  /** What a question asks about, in a word or two; empty: nothing is said. */
  readonly aboutOf: (comparison: Comparison) => string;
}

/** The comparisons as a tidy table, full precision. */
export function comparisonTable(
  name: string,
  comparisons: readonly Comparison[],
  { conditions: [first, second], simulated, aboutOf }: ComparedFacts,
): Table {
  return {
    name,
    columns: comparisonColumns,
    rows: comparisons.map((one) => ({
      simulated,
      of: one.of,
      about: aboutOf(one),
      unit: one.unit,
      first,
      second,
      n: one.pairs.length,
      mean_first: one.first?.mean ?? null,
      low_first: one.first?.interval?.low ?? null,
      high_first: one.first?.interval?.high ?? null,
      mean_second: one.second?.mean ?? null,
      low_second: one.second?.interval?.low ?? null,
      high_second: one.second?.interval?.high ?? null,
      difference: one.test?.meanDifference ?? null,
      low_difference: one.test?.interval?.low ?? null,
      high_difference: one.test?.interval?.high ?? null,
      t: one.test?.t ?? null,
      df: one.test?.df ?? null,
      p: one.test?.p ?? null,
      p_holm: one.holmP,
      dz: one.test?.dz ?? null,
      v: one.signedRank?.v ?? null,
      p_wilcoxon: one.signedRank?.p ?? null,
      p_wilcoxon_holm: one.signedRankHolmP,
      method_wilcoxon: one.signedRank?.method ?? '',
      rank_biserial: one.signedRank?.effect ?? null,
    })),
  };
}

const fTest = 'computed: analysis of variance, type III squares';
const ranks = "computed: Friedman's test; with one condition Kruskal and Wallis's";
const familyOfAll = 'computed: Holm over all measures of this table';

const overallColumns: readonly Column[] = [
  simulatedColumn,
  text('of', 'an id, or task/questionnaire/id', 'answers or scales', 'Question or scale.'),
  text(
    'effect',
    'conditions, cohorts, conditions and cohorts',
    'plan.json: conditions, cohorts',
    'Within participants, between them, and how far the first depends on the second.',
  ),
  number('n', '', '0, 1, 2 …', 'computed', 'Participants whose answers are complete.'),
  number('f', '', '0 and more', fTest, 'Empty: nothing spreads.'),
  number('df1', '', '1, 2, 3 …', fTest, 'Degrees of freedom of the effect.'),
  number('df2', '', '0, 1, 2 …', fTest, 'Degrees of freedom of the error.'),
  number('p', '', share, fTest, 'As if the differences of all conditions spread alike.'),
  number('epsilon', '', share, 'computed: Greenhouse and Geisser', 'Empty: of cohorts there is none.'),
  number('p_corrected', '', share, 'computed: F with both degrees of freedom times epsilon', 'The p to read.'),
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
  low_eta: effect.interval?.low ?? null,
  high_eta: effect.interval?.high ?? null,
});

/** The effects that were analysed, by name. */
export const effectsOf = (variance: VarianceAnalysis | null): readonly (readonly [string, Effect])[] =>
  (
    [
      ['conditions', variance?.within ?? null],
      ['cohorts', variance?.between ?? null],
      ['conditions and cohorts', variance?.interaction ?? null],
    ] as const
  ).flatMap(([name, effect]) => (effect ? [[name, effect] as const] : []));

/** The analyses of all conditions and cohorts at once as a tidy table: a row for each effect. */
export const overallTable = (name: string, comparisons: readonly OverallComparison[], simulated: boolean): Table => ({
  name,
  columns: overallColumns,
  rows: comparisons.flatMap(({ of, n, variance, ranks: byRanks, holmP, ranksHolmP }) =>
    effectsOf(variance).map(([effect, found], index) => ({
      simulated,
      of,
      effect,
      n,
      ...effectCells(found),
      // What belongs to the measure as a whole stands once.
      p_holm: index === 0 ? holmP : null,
      chi_squared: index === 0 ? (byRanks?.chiSquared ?? null) : null,
      df_ranks: index === 0 ? (byRanks?.df ?? null) : null,
      p_ranks: index === 0 ? (byRanks?.p ?? null) : null,
      effect_ranks: index === 0 ? (byRanks?.effect ?? null) : null,
      p_ranks_holm: index === 0 ? ranksHolmP : null,
    })),
  ),
});

/** Frame times as a tidy table. */
export const frameTimeTable = (rows: readonly FrameTimeRow[], simulated: boolean): Table => ({
  name: 'frame-times',
  columns: [
    simulatedColumn,
    text('task', ids, 'frame-times.csv', 'Id of the task.'),
    text('condition', ids, 'frame-times.csv', 'Id of the condition.'),
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

/** The paper's tables 9 and 10 with what follows from their t. */
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
    number('p_holm', '', share, 'computed: Holm over all twelve', 'The paper corrects for nothing.'),
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
