import type { Effect, VarianceAnalysis } from '../../statistics/analysis-of-variance';
import type { Interval } from '../../statistics/summaries';
import type { StudyPlan } from '../plan/plan';
import { boolean, type Cell, type Column, number, type Table, text } from '../tables/tidy-csv';
import type { OverallComparison } from './compare-all';
import type { Comparison } from './compare-conditions';
import type { FrameTimeRow } from './frame-times';
import { aboutOf, isPlanned, type MeasureName } from './measures';
import { checkedPaperRows } from './paper-tables';

/** The facts that tables of results state next to their figures. */
export interface TableFacts {
  /** planned: p is adjusted over the measures that the plan names only. */
  readonly family: 'planned' | 'explored';
  readonly simulated: boolean;
  readonly plan: StudyPlan;
}

const simulatedColumn = boolean(
  'simulated',
  'records: simulated',
  'TRUE: made by a program. It says nothing about people.',
);
const ids = 'small letters, digits, hyphens';
/** The range of p, ε and shares of variance. */
const share = '0 to 1';

/** The first columns of every table of compared measures. */
const measureColumns: readonly Column[] = [
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
const measureCells = (one: MeasureName, { simulated, plan }: TableFacts) => ({
  simulated,
  of: one.of,
  about: aboutOf(one, plan),
  unit: one.unit,
  planned: isPlanned(one, plan),
});

/** Returns the columns of the ends of an interval; `none` says when both are empty. */
const endColumns = (name: string, source: string, none?: string) => [
  number(`low_${name}`, '', 'any', source, 'Lower end of its 95 % confidence interval.'),
  number(`high_${name}`, '', 'any', source, none === undefined ? 'Upper end.' : `Upper end; both empty: ${none}.`),
];

const endCells = (name: string, ends: Interval | null | undefined) => ({
  [`low_${name}`]: ends?.low ?? null,
  [`high_${name}`]: ends?.high ?? null,
});

/** Comparisons of the same two sides; `conditions` are those over whose mean cohorts are compared. */
export interface ComparedSides {
  /** The ids: first − second. */
  readonly sides: readonly [string, string];
  readonly conditions?: readonly string[];
  readonly comparisons: readonly Comparison[];
}

/** The columns and terms by which tables of compared conditions differ from those of compared cohorts. */
interface TwoSides {
  /** The columns after those of the measure, and their cells. */
  readonly head: readonly Column[];
  readonly headCells: (sides: ComparedSides, one: Comparison) => Row;
  /** The population of each mean, and that of its interval. */
  readonly means: { readonly first: string; readonly second: string; readonly each: string };
  /** The test, its difference, and the case in which t is empty. */
  readonly t: { readonly test: string; readonly difference: string; readonly empty: string };
  readonly df: { readonly values: string; readonly description: string };
  readonly d: { readonly name: string; readonly source: string; readonly description: string };
  /** Wilcoxon's test: its name in columns and in words, its statistic, and the cases in which it is approximated. */
  readonly ranks: {
    readonly name: string;
    readonly test: string;
    readonly statistic: string;
    readonly description: string;
    readonly approximated: string;
  };
  /** The columns in which the rows of a family are equal. */
  readonly alike: string;
  /** The last columns of planned tests, and their cells. */
  readonly planned: { readonly columns: readonly Column[]; readonly cells: (one: Comparison) => Row };
}

type Row = Readonly<Record<string, Cell>>;

const equivalence = 'computed: two one-sided paired t-tests';

/** The claim of the hypothesis about a measure, and its test of equivalence. */
const claims: TwoSides['planned'] = {
  columns: [
    text('hypothesis', 'letters, digits, - and _', 'planned.csv', 'Id of the hypothesis about it; empty: none.'),
    number('margin', '', 'more than 0', 'planned.csv', 'Empty, as the next columns: it does not claim equivalence.'),
    number('low_equivalence', '', 'any', equivalence, 'Lower end of the 90 % confidence interval of the difference.'),
    number('high_equivalence', '', 'any', equivalence, 'Upper end. p is below .05 if both lie within the margin.'),
    number('t_equivalence', '', 'any', equivalence, 'The smaller t of both: (margin − |difference|) / standard error.'),
    number(
      'p_equivalence',
      '',
      share,
      equivalence,
      'The larger p of both: small if the difference is within the margin.',
    ),
    number(
      'p_equivalence_holm',
      '',
      share,
      'computed: Holm over the rows of this table with a margin and the same two conditions',
      'p_equivalence adjusted.',
    ),
  ],
  cells: ({ hypothesis, equivalence, equivalenceHolmP }) => ({
    hypothesis: hypothesis?.id ?? '',
    margin: hypothesis?.margin ?? null,
    ...endCells('equivalence', equivalence?.interval),
    t_equivalence: equivalence?.t ?? null,
    p_equivalence: equivalence?.p ?? null,
    p_equivalence_holm: equivalenceHolmP,
  }),
};

const twoConditions: TwoSides = {
  head: [
    text('first', ids, 'plan.json: conditions', 'Condition from which the other is subtracted.'),
    text('second', ids, 'plan.json: conditions', 'Condition that is subtracted.'),
    number('n', '', '0, 1, 2 …', 'computed', 'Pairs: participants, or groups where a group has one score.'),
  ],
  headCells: ({ sides: [first, second] }, { values }) => ({ first, second, n: values.first.length }),
  means: {
    first: 'under the first condition',
    second: 'under the second condition',
    each: 'each had under both conditions',
  },
  t: { test: 'paired t-test', difference: 'Mean of first − second.', empty: 'the differences do not vary' },
  df: { values: '0, 1, 2 …', description: 'Its degrees of freedom.' },
  d: { name: 'dz', source: 't / √n', description: "Cohen's d_z: mean difference in its standard deviations." },
  ranks: {
    name: 'wilcoxon',
    test: 'signed-rank test',
    statistic: 'v',
    description: 'Sum of the positive ranks.',
    approximated: 'ties, zeros and 50 pairs or more',
  },
  alike: 'two conditions',
  planned: claims,
};

const twoCohorts: TwoSides = {
  head: [
    text('first', ids, 'plan.json: cohorts', 'Cohort from which the other is subtracted.'),
    text('second', ids, 'plan.json: cohorts', 'Cohort that is subtracted.'),
    text(
      'condition',
      ids,
      'plan.json: conditions',
      'Condition; empty: the mean of each participant over all conditions.',
    ),
    number('n_first', '', '0, 1, 2 …', 'computed', 'Participants of the first (groups, where a group has one score).'),
    number('n_second', '', '0, 1, 2 …', 'computed', 'Of the second.'),
  ],
  headCells: ({ sides: [first, second], conditions = [] }, { values }) => ({
    ...{ first, second, condition: conditions.length === 1 ? (conditions[0] ?? '') : '' },
    ...{ n_first: values.first.length, n_second: values.second.length },
  }),
  means: { first: 'of the first cohort', second: 'of the second cohort', each: 'each of the cohort had' },
  t: { test: "Welch's t-test", difference: 'First − second.', empty: 'there are too few, or nothing varies' },
  df: { values: 'more than 0', description: 'Its degrees of freedom by Welch and Satterthwaite.' },
  d: { name: 'ds', source: 'difference / pooled standard deviation', description: "Cohen's d_s." },
  ranks: {
    name: 'rank_sum',
    test: "rank-sum test (Mann and Whitney's)",
    statistic: 'w',
    description: 'Pairs of both cohorts in which the first is larger; ties count half.',
    approximated: 'ties and 50 in a cohort or more',
  },
  alike: 'two cohorts, condition',
  planned: { columns: [], cells: () => ({}) },
};

function twoSidedColumns({ head, means, t, df, d, ranks, alike, planned }: TwoSides, family: TableFacts['family']) {
  const holm = `computed: Holm over the rows of this table with the same ${alike}${family === 'planned' ? '' : ' and unit'}`;
  const tTest = `computed: ${t.test}`;
  const wilcoxon = `computed: Wilcoxon's ${ranks.test}, as R's wilcox.test up to 4.5, ties within rounding`;
  const rankP = `p_${ranks.name}`;
  const meanColumns = (side: 'first' | 'second') => [
    number(`mean_${side}`, '', 'any', `computed: the mean of what ${means.each}`, `Mean ${means[side]}.`),
    ...endColumns(side, `computed: the interval of what ${means.each}`),
  ];
  return [
    ...measureColumns,
    ...head,
    ...meanColumns('first'),
    ...meanColumns('second'),
    number('difference', '', 'any', tTest, t.difference),
    ...endColumns('difference', tTest),
    number('t', '', 'any', tTest, `Empty: ${t.empty}.`),
    number('df', '', df.values, tTest, df.description),
    number('p', '', share, tTest, 'Its two-sided p.'),
    number('p_holm', '', share, holm, 'p adjusted.'),
    number(d.name, '', 'any', `computed: ${d.source}`, d.description),
    ...endColumns(d.name, 'computed: noncentral t', 'nothing varies, or t is too far out'),
    number(ranks.statistic, '', '0 and more', wilcoxon, ranks.description),
    number(rankP, '', share, wilcoxon, 'Its two-sided p.'),
    number(`${rankP}_holm`, '', share, holm, `${rankP} adjusted.`),
    text(`method_${ranks.name}`, 'exact, normal', wilcoxon, `normal: approximation for ${ranks.approximated}.`),
    number('rank_biserial', '', '-1 to 1', 'computed: (ranks for − ranks against) / all ranks', 'Its effect size.'),
    ...endColumns(
      'rank_biserial',
      "computed: Fisher's z with the standard error of the ranks where nothing differs",
      'all ranks are on one side',
    ),
    ...(family === 'planned' ? planned.columns : []),
  ];
}

const twoSidedCells = ({ d, ranks: { name, statistic } }: TwoSides, one: Comparison) => ({
  ...{ mean_first: one.first?.mean ?? null, ...endCells('first', one.first?.interval) },
  ...{ mean_second: one.second?.mean ?? null, ...endCells('second', one.second?.interval) },
  difference: one.test?.meanDifference ?? null,
  ...endCells('difference', one.test?.interval),
  t: one.test?.t ?? null,
  df: one.test?.df ?? null,
  p: one.test?.p ?? null,
  p_holm: one.holmP,
  [d.name]: one.test?.d ?? null,
  ...endCells(d.name, one.test?.dInterval),
  [statistic]: one.ranks?.statistic ?? null,
  [`p_${name}`]: one.ranks?.p ?? null,
  [`p_${name}_holm`]: one.ranksHolmP,
  [`method_${name}`]: one.ranks?.method ?? '',
  rank_biserial: one.ranks?.effect ?? null,
  ...endCells('rank_biserial', one.ranks?.effectInterval),
});

/** Returns a function that makes a tidy table of comparisons in full precision. */
const tableOf =
  (kind: TwoSides) =>
  (name: string, compared: readonly ComparedSides[], facts: TableFacts): Table => ({
    name,
    columns: twoSidedColumns(kind, facts.family),
    rows: compared.flatMap((sides) =>
      sides.comparisons.map((one) => ({
        ...measureCells(one, facts),
        ...kind.headCells(sides, one),
        ...twoSidedCells(kind, one),
        ...(facts.family === 'planned' ? kind.planned.cells(one) : {}),
      })),
    ),
  });

export const conditionsTable = tableOf(twoConditions);

export const cohortsTable = tableOf(twoCohorts);

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
