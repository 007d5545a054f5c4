import { element } from 'threepoint-ui/element';
import { type Comparison, compareConditions, type Results } from '../../model/results/compare-conditions';
import { comparisonTable } from '../../model/results/result-tables';
import { comparedTable, pairTesting } from './compared-tables';
import { type Chart, meansFigure, pairsFigure, questionCharts, scaleCharts, scoreCharts } from './comparison-figures';
import { bar, csvButton, plannedNote } from './result-cells';
import type { Compared, ShownResults } from './shown-results';

type Pairs = Compared<Comparison> & { readonly conditions: readonly [string, string] };

function saved({ results, conditions }: Pairs, file: string, comparisons: readonly Comparison[]): HTMLElement {
  const facts = results.factsOf(file.startsWith('planned') ? 'planned' : 'explored');
  return bar(csvButton(comparisonTable(file, [{ conditions, comparisons }], facts), results.fileOf(file)));
}

/** Returns the planned measures as a separate family; the exploratory results below show them again. */
function plannedParts(pairs: Pairs): readonly Node[] {
  const { planned } = pairs;
  if (planned.length === 0) return [];
  const caption = `Planned comparisons: means with 95 % confidence intervals, and tests; Holm over these ${planned.length} alone`;
  return [
    element('h3', {}, 'Planned'),
    comparedTable(pairs, pairTesting, caption, planned),
    saved(pairs, 'planned-compared', planned),
    plannedNote(),
  ];
}

const bothFigures = (pairs: Pairs) => (chart: Chart<Comparison>) =>
  element('div', { class: 'figures' }, meansFigure(pairs, chart), pairsFigure(pairs, chart));

function answerParts(pairs: Pairs): readonly Node[] {
  const { answers } = pairs;
  if (answers.length === 0) return [];
  const caption =
    'Exploratory: paired comparisons of the answers: means with 95 % confidence intervals, and tests (the paper’s tables 9 and 10)';
  return [
    element('h3', {}, 'Questionnaires'),
    ...questionCharts(pairs).map(bothFigures(pairs)),
    comparedTable(pairs, pairTesting, caption, answers),
    saved(pairs, 'answers-compared', answers),
  ];
}

function scaleParts(pairs: Pairs): readonly Node[] {
  const { scales } = pairs;
  if (scales.length === 0) return [];
  const caption =
    'Exploratory: paired comparisons of the scales: means with 95 % confidence intervals, and tests; Holm over the scales of this table';
  return [
    element('h3', {}, 'Scales'),
    ...scaleCharts(pairs).map(bothFigures(pairs)),
    comparedTable(pairs, pairTesting, caption, scales),
    saved(pairs, 'scales-compared', scales),
  ];
}

function scoreParts(pairs: Pairs): readonly Node[] {
  const both = [...pairs.points, ...pairs.percent];
  if (both.length === 0) return [];
  const caption =
    'Exploratory: paired comparisons of the scores: means of the blocks’ trials with 95 % confidence intervals, and tests';
  return [
    element('h3', {}, 'Scores'),
    ...scoreCharts(pairs).map(bothFigures(pairs)),
    comparedTable(pairs, pairTesting, caption, both),
    saved(pairs, 'scores-compared', both),
  ];
}

/** Returns the comparison of two conditions, first − second: figures, tables and the participants that are left out. */
export function pairResults(
  results: ShownResults,
  conditions: readonly [string, string],
): { readonly nodes: readonly Node[]; readonly excluded: Results['excluded'] } {
  const { measures, labelOf } = results;
  const answers = compareConditions(measures.answers, conditions);
  const scales = compareConditions(measures.scales, conditions);
  const points = compareConditions(measures.points, conditions);
  const pairs: Pairs = {
    results,
    conditions,
    labels: { first: labelOf(conditions[0]), second: labelOf(conditions[1]) },
    answers: answers.comparisons,
    scales: scales.comparisons,
    points: points.comparisons,
    percent: compareConditions(measures.percent, conditions).comparisons,
    planned: compareConditions(measures.planned, conditions).comparisons,
  };
  const { first, second } = pairs.labels;
  const note = `Differences are ${first} − ${second}, paired within participants (scores of groups: within groups). Tests are two-sided; * marks Holm’s p below .05, adjusted over its table (scores: points and per cent separately).`;
  return {
    nodes: [
      element('p', { class: 'soft' }, note),
      ...plannedParts(pairs),
      ...answerParts(pairs),
      ...scaleParts(pairs),
      ...scoreParts(pairs),
    ],
    excluded: [...answers.excluded, ...scales.excluded, ...points.excluded],
  };
}
