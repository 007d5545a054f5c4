import { element } from 'threepoint-ui/element';
import type { OverallComparison } from '../../model/results/compare-all';
import { comparedAsAWhole, overallComparisons } from '../../model/results/exported-results';
import type { Measure } from '../../model/results/measures';
import { effectsOf, overallTable } from '../../model/results/result-tables';
import { type TableRow, tableNode } from '../table';
import { bar, csvButton, fixed, meanCell, measureCell, none, plannedNote, pText } from './result-cells';
import type { ShownResults } from './shown-results';

const heads = [
  { text: 'Measure' },
  { text: 'n', title: 'Participants (for scores: groups) with complete values', numeric: true },
  { text: 'effect' },
  { text: 'F', numeric: true },
  { text: 'df', numeric: true },
  { text: 'p', title: 'Corrected by Greenhouse and Geisser’s ε, if there is one', numeric: true },
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

/** Returns a row for each effect of a measure. The test by ranks is in the first row. */
function rowsOf(results: ShownResults, one: OverallComparison, tagged: boolean): readonly TableRow[] {
  const { n, variance, ranks, holmP, ranksHolmP } = one;
  return effectsOf(variance).map(([name, effect], index) => {
    const first = index === 0;
    return {
      cells: [
        first ? measureCell(results, one, tagged) : '',
        first ? String(n) : '',
        name,
        fixed(effect.f, 3),
        effect.df.join(', '),
        pText(effect.correctedP ?? effect.p),
        fixed(effect.epsilon, 3),
        meanCell(effect.partialEtaSquared, effect.interval, 2),
        first ? pText(holmP) : none,
        first ? fixed(ranks?.chiSquared, 3) : none,
        first ? pText(ranks?.p) : none,
        first ? pText(ranksHolmP) : none,
      ],
    };
  });
}

/** Returns the table of one family of tests with the participants that are left out. */
function familyParts(
  results: ShownResults,
  { file, caption }: { readonly file: string; readonly caption: (count: number) => string },
  measures: readonly Measure[],
): readonly Node[] {
  const { study, fileOf } = results;
  const compared = overallComparisons(measures, study.plan);
  if (compared.length === 0) return [];
  const planned = file.startsWith('planned');
  const leftOut = [...new Set(compared.flatMap((one) => one.leftOut))];
  return [
    tableNode(
      caption(compared.length),
      heads,
      compared.flatMap((one) => rowsOf(results, one, !planned)),
      'dense',
    ),
    bar(csvButton(overallTable(file, compared, { ...study, family: planned ? 'planned' : 'explored' }), fileOf(file))),
    ...(leftOut.length === 0
      ? []
      : [
          element(
            'p',
            { class: 'soft' },
            `Left out of some analyses because a value is missing:  ${leftOut.join(', ')}.`,
          ),
        ]),
    ...(planned ? [plannedNote()] : []),
  ];
}

const analyses = 'analyses of variance, and tests by ranks';

/**
 * Returns the analyses of all conditions and cohorts at once; nothing for two conditions without cohorts, which are
 * compared in pairs.
 */
export function overallResults(results: ShownResults): readonly Node[] {
  const { study, measures } = results;
  if (!comparedAsAWhole(study.plan)) return [];
  const explored = (name: string) => () => `Exploratory: ${name}: ${analyses}`;
  const plannedCaption = (count: number) => `Planned: ${analyses}; Holm over these ${count} alone`;
  return [
    element('h2', {}, study.plan.cohorts ? 'All conditions and cohorts together' : 'All conditions together'),
    ...familyParts(results, { file: 'planned-overall', caption: plannedCaption }, measures.planned),
    ...familyParts(results, { file: 'answers-overall', caption: explored('questions') }, measures.answers),
    ...familyParts(results, { file: 'scales-overall', caption: explored('scales') }, measures.scales),
    ...familyParts(results, { file: 'scores-overall', caption: explored('scores in points') }, measures.points),
  ];
}
