import { element } from 'threepoint-ui';
import { type ComparedCohorts, compareCohorts } from '../../model/results/compare-cohorts';
import { type Comparison, compareConditions, type Results } from '../../model/results/compare-conditions';
import type { ByFamily } from '../../model/results/exported-results';
import { type ComparedSides, cohortsTable, conditionsTable } from '../../model/results/result-tables';
import { comparedTable } from './compared-tables';
import { chartFigures, questionCharts, scaleCharts, scoreCharts } from './comparison-figures';
import { bar, csvButton, plannedNote } from './result-cells';
import type { ShownComparison, ShownResults } from './shown-results';

const withIntervals = 'means with 95 % confidence intervals, and tests';

/** Returns the captions of the tables; the exploratory ones show planned measures again. */
function captionsOf({ between, planned }: ShownComparison) {
  const alone = `Holm over these ${planned.length} alone`;
  const explored = (what: string, ofPairs: string) =>
    between
      ? `Exploratory: ${what}, ${withIntervals} between participants`
      : `Exploratory: paired comparisons of the ${what}: ${ofPairs}`;
  return {
    planned: between
      ? `Planned: ${withIntervals} between participants; ${alone}`
      : `Planned comparisons: ${withIntervals}; ${alone}`,
    answers: explored('answers', `${withIntervals} (the paper’s tables 9 and 10)`),
    scales: explored('scales', `${withIntervals}; Holm over the scales of this table`),
    scores: explored('scores', 'means of the blocks’ trials with 95 % confidence intervals, and tests'),
  };
}

type Sides = Omit<ComparedSides, 'comparisons'>;

/** Returns the figures and the table of every family with comparisons, with buttons that save them. */
function familyParts(compared: ShownComparison, sides: Sides): readonly Node[] {
  const { results, between, planned, answers, scales, points, percent } = compared;
  const captions = captionsOf(compared);
  const families = [
    ['planned', 'Planned', planned, []],
    ['answers', 'Questionnaires', answers, questionCharts(compared)],
    ['scales', 'Scales', scales, scaleCharts(compared)],
    ['scores', 'Scores', [...points, ...percent], scoreCharts(compared)],
  ] as const;
  return families.flatMap(([name, heading, comparisons, charts]) => {
    if (comparisons.length === 0) return [];
    const file = `${name}-${between ? 'cohorts' : 'compared'}`;
    const facts = { ...results.study, family: name === 'planned' ? 'planned' : 'explored' } as const;
    const table = (between ? cohortsTable : conditionsTable)(file, [{ ...sides, comparisons }], facts);
    return [
      element('h3', {}, between ? `${heading}, between cohorts` : heading),
      ...charts.map((chart) => chartFigures(compared, chart)),
      comparedTable(compared, captions[name], comparisons),
      bar(csvButton(table, results.fileOf(file))),
      ...(name === 'planned' ? [plannedNote()] : []),
    ];
  });
}

/** Returns two sides as they are shown: a note about them, and every family of `comparisons`. */
function twoSidedParts(
  results: ShownResults,
  sides: Sides,
  comparisons: ByFamily<readonly Comparison[]>,
  within: string,
): readonly Node[] {
  const [first, second] = sides.sides.map(results.labelOf) as [string, string];
  const compared = { results, between: sides.conditions !== undefined, labels: { first, second }, ...comparisons };
  const note = `Differences are ${first} − ${second}, ${within}. Tests are two-sided; * marks Holm’s p below .05, adjusted over its table (scores: points and per cent separately).`;
  return [element('p', { class: 'soft' }, note), ...familyParts(compared, sides)];
}

const mapFamilies = <A, B>({ answers, scales, points, percent, planned }: ByFamily<A>, of: (one: A) => B) => ({
  ...{ answers: of(answers), scales: of(scales), points: of(points), percent: of(percent), planned: of(planned) },
});

/** Returns the comparison of two conditions, first − second: figures, tables and the participants that are left out. */
export function pairResults(
  results: ShownResults,
  sides: readonly [string, string],
): { readonly nodes: readonly Node[]; readonly excluded: Results['excluded'] } {
  const found = mapFamilies(results.measures, (measures) => compareConditions(measures, sides));
  const comparisons = mapFamilies(found, (one) => one.comparisons);
  const within = 'paired within participants (scores of groups: within groups)';
  return {
    nodes: twoSidedParts(results, { sides }, comparisons, within),
    excluded: [...found.answers.excluded, ...found.scales.excluded, ...found.points.excluded],
  };
}

/** Returns the comparison of two cohorts, first − second, by each participant's mean under the chosen conditions. */
export function cohortResults(results: ShownResults, compared: ComparedCohorts): readonly Node[] {
  const comparisons = mapFamilies(results.measures, (measures) => compareCohorts(measures, compared));
  const [only, ...others] = compared.conditions;
  const under =
    only !== undefined && others.length === 0
      ? `under “${results.labelOf(only)}”`
      : 'by the mean of each participant over all conditions';
  const within = `between participants (scores of groups: between groups), ${under}`;
  return twoSidedParts(results, compared, comparisons, within);
}
