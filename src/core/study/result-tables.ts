import type { Comparison } from './compare-conditions';
import type { FrameTimeRow } from './frame-times';
import { checkedPaperRows } from './paper-tables';
import { type Column, number, type Table, text } from './tidy-csv';

const simulatedColumn: Column = {
  name: 'simulated',
  type: 'boolean',
  unit: '',
  description: 'TRUE: made by a program. It says nothing about people.',
};

const comparisonColumns: readonly Column[] = [
  simulatedColumn,
  text('of', 'Question, or task whose scores are compared.'),
  text('about', 'What the question asks about; empty for scores.'),
  text('unit', 'answer (as the scale of the question goes), points or percent.'),
  text('first', 'Condition whose values the difference begins with.'),
  text('second', 'Condition that is subtracted.'),
  number('n', '', 'Pairs: participants, or groups where a group has one score.'),
  number('mean_first', '', 'Mean under the first condition.'),
  number('low_first', '', 'Lower end of its 95 % confidence interval.'),
  number('high_first', '', 'Upper end.'),
  number('mean_second', '', 'Mean under the second condition.'),
  number('low_second', '', 'Lower end of its 95 % confidence interval.'),
  number('high_second', '', 'Upper end.'),
  number('difference', '', 'Mean of first − second.'),
  number('low_difference', '', 'Lower end of its 95 % confidence interval.'),
  number('high_difference', '', 'Upper end.'),
  number('t', '', 'Paired t-test; empty: the differences do not vary.'),
  number('df', '', 'Its degrees of freedom.'),
  number('p', '', 'Its two-sided p.'),
  number('p_holm', '', 'Adjusted by Holm over the family of this table.'),
  number('dz', '', "Cohen's d_z: mean difference in its standard deviations."),
  number('v', '', "Wilcoxon's signed ranks: sum of the positive ranks."),
  number('p_wilcoxon', '', 'Its two-sided p.'),
  number('p_wilcoxon_holm', '', 'Adjusted by Holm.'),
  text('method_wilcoxon', 'exact or normal (approximation for ties and zeros).'),
  number('rank_biserial', '', 'Its effect size, −1 to 1.'),
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

/** Frame times as a tidy table. */
export const frameTimeTable = (rows: readonly FrameTimeRow[], simulated: boolean): Table => ({
  name: 'frame-times',
  columns: [
    simulatedColumn,
    text('task', 'Id of the task.'),
    text('condition', 'Id of the condition.'),
    text('stage', 'Stage of the frame; "frame" is all of its work.'),
    number('trials', '', 'Trials that count.'),
    number('frames', '', 'Frames measured in them.'),
    number('min', 'ms', 'Shortest.'),
    number('max', 'ms', 'Longest.'),
    number('mean', 'ms', 'Mean over all frames.'),
    number('worst_p95', 'ms', "Largest of the trials' 95th percentiles."),
    number('missed', '', 'Frames shown late, in any stage.'),
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

/** The paper's tables 9 and 10 with what follows from their t. */
export const paperTable = (): Table => ({
  name: 'paper-check',
  columns: [
    text('question', 'Id.'),
    number('ours', '', 'Mean under the method of the paper, as printed.'),
    number('ik', '', 'Mean under inverse kinematics, as printed.'),
    number('t', '', 'As printed.'),
    number('printed_p', '', 'As printed.'),
    number('p', '', 'Two-sided p that follows from t with 14 degrees of freedom.'),
    { name: 'follows', type: 'boolean', unit: '', description: 'Whether the printed p follows from the printed t.' },
    number('p_holm', '', 'Adjusted by Holm over all twelve; the paper corrects for nothing.'),
    number('dz', '', "Cohen's d_z = t / √15."),
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
