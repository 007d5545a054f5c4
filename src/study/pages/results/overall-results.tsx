import type { OverallComparison } from '../../model/results/compare-all';
import { hasOverallAnalysis, overallComparisons } from '../../model/results/exported-results';
import { effectsOf, overallTable } from '../../model/results/result-tables';
import { type Column, numberColumn, Table, textColumn } from '../table';
import { csvButton, fixed, meanCell, measureCell, none, PlannedNote, pText } from './result-cells';
import type { ShownResults } from './shown-results';

/** An effect of a measure. The test by ranks is in the row of the first effect. */
interface EffectRow {
  readonly name: string;
  readonly effect: ReturnType<typeof effectsOf>[number][1];
  readonly of: OverallComparison;
  readonly first: boolean;
}

const ofFirst = ({ first }: EffectRow, text: string) => (first ? text : none);
const etaCell = ({ partialEtaSquared, interval }: EffectRow['effect']) => meanCell(partialEtaSquared, interval, 2);

const rowsOf = (of: OverallComparison): readonly EffectRow[] =>
  effectsOf(of.variance).map(([name, effect], index) => ({ name, effect, of, first: index === 0 }));

const pTitle = 'Corrected by Greenhouse and Geisser’s ε, if there is one';
const ranksTitle = 'Friedman’s test of the conditions; with one condition, Kruskal and Wallis’s of the cohorts';

/** Returns the columns of a table; `tagged`: planned measures are marked. */
const columnsOf = (results: ShownResults, tagged: boolean): readonly Column<EffectRow>[] => [
  textColumn('Measure', ({ of, first }) => first && measureCell(results, of, tagged)),
  numberColumn('n', ({ of, first }) => first && of.n, 'Participants (for scores: groups) with complete values'),
  textColumn('effect', ({ name }) => name),
  numberColumn('F', ({ effect }) => fixed(effect.f, 3)),
  numberColumn('df', ({ effect }) => effect.df.join(', ')),
  numberColumn('p', ({ effect }) => pText(effect.correctedP ?? effect.p), pTitle),
  numberColumn('ε', ({ effect }) => fixed(effect.epsilon, 3), 'Greenhouse and Geisser'),
  numberColumn('partial η²', ({ effect }) => etaCell(effect), 'With its 90 % confidence interval'),
  numberColumn('Holm p', (row) => ofFirst(row, pText(row.of.holmP)), 'Adjusted over all measures of this table'),
  numberColumn('χ²', (row) => ofFirst(row, fixed(row.of.ranks?.chiSquared, 3)), ranksTitle),
  numberColumn('p (χ²)', (row) => ofFirst(row, pText(row.of.ranks?.p))),
  numberColumn('Holm p (χ²)', (row) => ofFirst(row, pText(row.of.ranksHolmP))),
];

const analyses = 'analyses of variance, and tests by ranks';

/**
 * The analyses of all conditions and cohorts at once, with the participants that are left out; nothing for two
 * conditions without cohorts, which are compared in pairs.
 */
export function OverallResults({ results }: { readonly results: ShownResults }) {
  const { study, measures, fileOf } = results;
  if (!hasOverallAnalysis(study.plan)) return null;
  const families = [
    ['planned', measures.planned, ''],
    ['answers', measures.answers, 'questions'],
    ['scales', measures.scales, 'scales'],
    ['scores', measures.points, 'scores in points'],
  ] as const;
  return (
    <>
      <h2>{study.plan.cohorts ? 'All conditions and cohorts together' : 'All conditions together'}</h2>
      {families.map(([name, measured, what]) => {
        const compared = overallComparisons(measured, study.plan);
        if (compared.length === 0) return null;
        const planned = name === 'planned';
        const file = `${name}-overall`;
        const table = overallTable(file, compared, { ...study, family: planned ? 'planned' : 'explored' });
        const leftOut = [...new Set(compared.flatMap((one) => one.leftOut))];
        return (
          <>
            <Table
              caption={
                planned
                  ? `Planned: ${analyses}; Holm over these ${compared.length} alone`
                  : `Exploratory: ${what}: ${analyses}`
              }
              columns={columnsOf(results, !planned)}
              rows={compared.flatMap(rowsOf)}
              dense
            />
            <div class="bar">{csvButton(table, fileOf(file))}</div>
            {leftOut.length > 0 && (
              <p class="soft">{`Left out of some analyses because a value is missing: ${leftOut.join(', ')}.`}</p>
            )}
            {planned && <PlannedNote />}
          </>
        );
      })}
    </>
  );
}
