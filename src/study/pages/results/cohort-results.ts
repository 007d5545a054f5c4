import { element } from 'threepoint-ui/element';
import { cohortTable } from '../../model/results/cohort-table';
import { type CohortComparison, type ComparedCohorts, compareCohorts } from '../../model/results/compare-cohorts';
import { cohortTesting, comparedTable } from './compared-tables';
import { type Chart, meansFigure, questionCharts, scaleCharts, scoreCharts, stripFigure } from './comparison-figures';
import { bar, csvButton, plannedNote } from './result-cells';
import type { Compared, ShownResults } from './shown-results';

type Cohorts = Compared<CohortComparison> & { readonly compared: ComparedCohorts };

/** Returns a table of comparisons with its download button. */
function tableOf(cohorts: Cohorts, file: string, caption: string, comparisons: readonly CohortComparison[]) {
  const { results, compared } = cohorts;
  const facts = results.factsOf(file.startsWith('planned') ? 'planned' : 'explored');
  const table = cohortTable(file, [{ compared, comparisons }], facts);
  return [comparedTable(cohorts, cohortTesting, caption, comparisons), bar(csvButton(table, results.fileOf(file)))];
}

const means = 'means with 95 % confidence intervals, and tests between participants';

function plannedParts(cohorts: Cohorts): readonly Node[] {
  const { planned } = cohorts;
  if (planned.length === 0) return [];
  return [
    element('h3', {}, 'Planned, between cohorts'),
    ...tableOf(cohorts, 'planned-cohorts', `Planned: ${means}; Holm over these ${planned.length} alone`, planned),
    plannedNote(),
  ];
}

/** Returns charts of means and of participants side by side. */
const figuresOf = (cohorts: Cohorts, charts: readonly Chart<CohortComparison>[]) =>
  charts.map((chart) => {
    const own = { ...chart, file: `${chart.file}-cohorts`, note: '' };
    return element('div', { class: 'figures' }, meansFigure(cohorts, own), stripFigure(cohorts, own));
  });

function answerParts(cohorts: Cohorts): readonly Node[] {
  const { answers } = cohorts;
  if (answers.length === 0) return [];
  return [
    element('h3', {}, 'Questionnaires, between cohorts'),
    ...figuresOf(cohorts, questionCharts(cohorts)),
    ...tableOf(cohorts, 'answers-cohorts', `Exploratory: answers, ${means}`, answers),
  ];
}

function scaleParts(cohorts: Cohorts): readonly Node[] {
  const { scales } = cohorts;
  if (scales.length === 0) return [];
  return [
    element('h3', {}, 'Scales, between cohorts'),
    ...figuresOf(cohorts, scaleCharts(cohorts)),
    ...tableOf(cohorts, 'scales-cohorts', `Exploratory: scales, ${means}`, scales),
  ];
}

function scoreParts(cohorts: Cohorts): readonly Node[] {
  const both = [...cohorts.points, ...cohorts.percent];
  if (both.length === 0) return [];
  return [
    element('h3', {}, 'Scores, between cohorts'),
    ...figuresOf(cohorts, scoreCharts(cohorts)),
    ...tableOf(cohorts, 'scores-cohorts', `Exploratory: scores, ${means}`, both),
  ];
}

/** Returns the comparison of two cohorts, first − second, by each participant's mean under the chosen conditions. */
export function cohortResults(results: ShownResults, compared: ComparedCohorts): readonly Node[] {
  const { measures, labelOf } = results;
  const [first, second] = compared.cohorts;
  const cohorts: Cohorts = {
    results,
    compared,
    labels: { first: labelOf(first), second: labelOf(second) },
    answers: compareCohorts(measures.answers, compared),
    scales: compareCohorts(measures.scales, compared),
    points: compareCohorts(measures.points, compared),
    percent: compareCohorts(measures.percent, compared),
    planned: compareCohorts(measures.planned, compared),
  };
  const under =
    compared.conditions.length === 1
      ? `under “${labelOf(compared.conditions[0] ?? '')}”`
      : 'by the mean of each participant over all conditions';
  const note = `Differences are ${labelOf(first)} − ${labelOf(second)}, between participants (scores of groups: between groups), ${under}. Tests are two-sided; * marks Holm’s p below .05, adjusted over its table (scores: points and per cent separately).`;
  return [
    element('p', { class: 'soft' }, note),
    ...plannedParts(cohorts),
    ...answerParts(cohorts),
    ...scaleParts(cohorts),
    ...scoreParts(cohorts),
  ];
}
