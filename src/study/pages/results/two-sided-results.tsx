import { type ComparedCohorts, compareCohorts } from '../../model/results/compare-cohorts';
import { type Comparison, compareConditions, type Results } from '../../model/results/compare-conditions';
import type { ByFamily } from '../../model/results/exported-results';
import { type ComparedSides, cohortsTable, conditionsTable } from '../../model/results/result-tables';
import { comparedTable } from './compared-tables';
import { chartFigures, questionCharts, scaleCharts, scoreCharts } from './comparison-figures';
import { hypothesisResults } from './hypothesis-results';
import { csvButton, PlannedNote } from './result-cells';
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

/** Returns two sides: a note about them, and the figures and the table of every family of comparisons. */
function twoSides(
  results: ShownResults,
  sides: Omit<ComparedSides, 'comparisons'>,
  found: ByFamily<readonly Comparison[]>,
  within: string,
) {
  const [first, second] = sides.sides.map(results.labelOf) as [string, string];
  const between = sides.conditions !== undefined;
  const [placeOfFirst, placeOfSecond] = sides.sides.map(results.placeOf) as [number, number];
  const order = placeOfFirst < placeOfSecond ? (['first', 'second'] as const) : (['second', 'first'] as const);
  const compared = { results, between, labels: { first, second }, order, ...found };
  const captions = captionsOf(compared);
  const { planned, answers, scales, points, percent } = found;
  const families = [
    ['planned', 'Planned', planned, []],
    ['answers', 'Questionnaires', answers, questionCharts(compared)],
    ['scales', 'Scales', scales, scaleCharts(compared)],
    ['scores', 'Scores', [...points, ...percent], scoreCharts(compared)],
  ] as const;
  return (
    <>
      <p class="soft">
        {`Differences are ${first} − ${second}, ${within}. Tests are two-sided; * marks Holm’s p below .05, adjusted over its table (scores: points and per cent separately).`}
      </p>
      {families.map(([name, heading, comparisons, charts]) => {
        if (comparisons.length === 0) return null;
        const file = `${name}-${between ? 'cohorts' : 'compared'}`;
        const facts = { ...results.study, family: name === 'planned' ? 'planned' : 'explored' } as const;
        const table = (between ? cohortsTable : conditionsTable)(file, [{ ...sides, comparisons }], facts);
        return (
          <>
            <h3>{between ? `${heading}, between cohorts` : heading}</h3>
            {name === 'planned' && hypothesisResults(results, comparisons)}
            {charts.map((chart) => chartFigures(compared, chart))}
            {comparedTable(compared, captions[name], comparisons)}
            <div class="bar">{csvButton(table, results.fileOf(file))}</div>
            {name === 'planned' && <PlannedNote />}
          </>
        );
      })}
    </>
  );
}

const mapFamilies = <A, B>({ answers, scales, points, percent, planned }: ByFamily<A>, of: (one: A) => B) => ({
  ...{ answers: of(answers), scales: of(scales), points: of(points), percent: of(percent), planned: of(planned) },
});

/** Two compared conditions, first − second, and what is left out of the comparison. */
export interface ComparedPair {
  readonly sides: readonly [string, string];
  readonly comparisons: ByFamily<readonly Comparison[]>;
  readonly excluded: Results['excluded'];
}

export function comparePair({ measures, study }: ShownResults, sides: readonly [string, string]): ComparedPair {
  const found = mapFamilies(measures, (family) => compareConditions(family, sides, study.plan));
  return {
    sides,
    comparisons: mapFamilies(found, (one) => one.comparisons),
    excluded: [...found.answers.excluded, ...found.scales.excluded, ...found.points.excluded],
  };
}

/** Returns the comparison of two conditions: figures and tables. */
export const pairResults = (results: ShownResults, { sides, comparisons }: ComparedPair) =>
  twoSides(results, { sides }, comparisons, 'paired within participants (scores of groups: within groups)');

/** Returns the comparison of two cohorts, first − second, by each participant's mean under the chosen conditions. */
export function cohortResults(results: ShownResults, compared: ComparedCohorts) {
  const [only, ...others] = compared.conditions;
  const under =
    only !== undefined && others.length === 0
      ? `under “${results.labelOf(only)}”`
      : 'by the mean of each participant over all conditions';
  const comparisons = mapFamilies(results.measures, (family) => compareCohorts(family, compared));
  const within = `between participants (scores of groups: between groups), ${under}`;
  return twoSides(results, compared, comparisons, within);
}
