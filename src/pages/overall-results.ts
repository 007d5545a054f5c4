import type { Effect } from '../core/statistics/analysis-of-variance';
import type { AnswerRow } from '../core/study/answer-tables';
import type { OverallComparison } from '../core/study/compare-all';
import { comparedAsAWhole, overallComparisons } from '../core/study/exported-results';
import { plannedAnalyses } from '../core/study/planned';
import { effectsOf, overallTable } from '../core/study/result-tables';
import { answersIn, scalesIn } from '../core/study/study-tables';
import { element } from '../ui/element';
import { csvButton, fixed, none, pText } from './result-cells';
import type { ShownStudy } from './shown-results';
import { tableNode } from './table';

const heads = [
  { text: 'Measure' },
  { text: 'n', title: 'Participants whose answers are complete', numeric: true },
  { text: 'effect' },
  { text: 'F', numeric: true },
  { text: 'df', numeric: true },
  { text: 'p', title: 'Corrected by Greenhouse and Geisser’s ε where there is one', numeric: true },
  { text: 'ε', title: 'Greenhouse and Geisser', numeric: true },
  { text: 'partial η²', title: 'With its 90 % confidence interval', numeric: true },
  { text: 'Holm p', title: 'Adjusted over all measures of this table', numeric: true },
  {
    text: 'χ²',
    title: 'Friedman’s test of the conditions; with one condition, Kruskal and Wallis’s of the cohorts',
    numeric: true,
  },
  { text: 'p (χ²)', numeric: true },
  { text: 'Holm p (χ²)', numeric: true },
] as const;

function etaText({ partialEtaSquared, interval }: Effect): string {
  const between = interval ? ` [${fixed(interval.low, 2)}, ${fixed(interval.high, 2)}]` : '';
  return `${fixed(partialEtaSquared, 2)}${between}`;
}

/** The rows of one measure: an effect each. What is tested by ranks stands beside the first. */
function rowsOf({ of, n, variance, ranks, holmP, ranksHolmP }: OverallComparison) {
  return effectsOf(variance).map(([name, effect], index) => {
    const first = index === 0;
    return {
      cells: [
        first ? of : '',
        first ? String(n) : '',
        name,
        fixed(effect.f, 3),
        effect.df.join(', '),
        pText(effect.correctedP ?? effect.p),
        fixed(effect.epsilon, 3),
        etaText(effect),
        first ? pText(holmP) : none,
        first ? fixed(ranks?.chiSquared, 3) : none,
        first ? pText(ranks?.p) : none,
        first ? pText(ranksHolmP) : none,
      ],
    };
  });
}

/** Analyses of all conditions and cohorts at once; none for two conditions without cohorts, which are compared in pairs. */
export function overallResults({ plan, simulated, records }: ShownStudy): readonly Node[] {
  if (!comparedAsAWhole(plan)) return [];
  const table = (name: string, file: string, rows: readonly AnswerRow[]) => {
    const compared = overallComparisons(rows, plan);
    const leftOut = [...new Set(compared.flatMap((one) => one.leftOut))];
    if (compared.length === 0) return [];
    return [
      tableNode(`${name}: analyses of variance, and tests by ranks`, heads, compared.flatMap(rowsOf)),
      element(
        'div',
        { class: 'bar' },
        csvButton(overallTable(file, compared, simulated), `${simulated ? 'SIMULATED-' : ''}${plan.id}-${file}`),
      ),
      ...(leftOut.length === 0
        ? []
        : [element('p', { class: 'soft' }, `Left out somewhere for want of a valid answer: ${leftOut.join(', ')}.`)]),
    ];
  };
  const planned = plannedAnalyses(
    [answersIn(records, plan), scalesIn(records, plan)].flatMap((rows) => overallComparisons(rows, plan)),
    plan,
  );
  const plannedPart =
    planned.length === 0
      ? []
      : [
          tableNode(
            `Planned: analyses of variance, and tests by ranks; Holm over these ${planned.length} alone. What follows is exploratory`,
            heads,
            planned.flatMap(rowsOf),
          ),
        ];
  return [
    element('h2', {}, plan.cohorts ? 'All conditions and cohorts together' : 'All conditions together'),
    ...plannedPart,
    ...table('Questions', 'answers-overall', answersIn(records, plan)),
    ...table('Scales', 'scales-overall', scalesIn(records, plan)),
  ];
}
