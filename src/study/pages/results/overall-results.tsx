import { element } from 'threepoint-ui';
import type { OverallComparison } from '../../model/results/compare-all';
import { hasOverallAnalysis, overallComparisons } from '../../model/results/exported-results';
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

const analyses = 'analyses of variance, and tests by ranks';

/**
 * Returns the analyses of all conditions and cohorts at once, with the participants that are left out; nothing for two
 * conditions without cohorts, which are compared in pairs.
 */
export function overallResults(results: ShownResults): readonly Node[] {
  const { study, measures, fileOf } = results;
  if (!hasOverallAnalysis(study.plan)) return [];
  const families = [
    ['planned', measures.planned, ''],
    ['answers', measures.answers, 'questions'],
    ['scales', measures.scales, 'scales'],
    ['scores', measures.points, 'scores in points'],
  ] as const;
  const parts = families.flatMap(([name, measured, what]) => {
    const compared = overallComparisons(measured, study.plan);
    if (compared.length === 0) return [];
    const planned = name === 'planned';
    const file = `${name}-overall`;
    const table = overallTable(file, compared, { ...study, family: planned ? 'planned' : 'explored' });
    const leftOut = [...new Set(compared.flatMap((one) => one.leftOut))];
    const missing = `Left out of some analyses because a value is missing:  ${leftOut.join(', ')}.`;
    return [
      tableNode(
        planned
          ? `Planned: ${analyses}; Holm over these ${compared.length} alone`
          : `Exploratory: ${what}: ${analyses}`,
        heads,
        compared.flatMap((one) => rowsOf(results, one, !planned)),
        'dense',
      ),
      bar(csvButton(table, fileOf(file))),
      ...(leftOut.length === 0 ? [] : [element('p', { class: 'soft' }, missing)]),
      ...(planned ? [plannedNote()] : []),
    ];
  });
  return [
    element('h2', {}, study.plan.cohorts ? 'All conditions and cohorts together' : 'All conditions together'),
    ...parts,
  ];
}
