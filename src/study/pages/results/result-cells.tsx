import { gameNames, games } from 'threepoint-games/all';
import { offerDownload } from 'threepoint-ui';
import { Button } from 'threepoint-ui/controls';
import { shippedQuestionnaires } from '../../model/questionnaires/questionnaires';
import { isPlanned, type MeasureName } from '../../model/results/measures';
import { type Table, tidyCsv } from '../../model/tables/tidy-csv';
import type { Interval } from '../../statistics/summaries';
import type { ShownResults } from './shown-results';

/** The text of a cell without a number. */
export const none = '–';
export const fixed = (value: number | null | undefined, digits: number) =>
  value == null ? none : value.toFixed(digits).replace('-', '−');
export const pText = (p: number | null | undefined) =>
  p == null ? none : p < 0.0005 ? '< .001' : p.toFixed(3).replace(/^0/, '');

export const meanCell = (mean: number | null | undefined, between: Interval | null | undefined, digits: number) => (
  <div>
    {fixed(mean, digits)}
    <div class="soft interval">{between && `[${fixed(between.low, digits)}, ${fixed(between.high, digits)}]`}</div>
  </div>
);

/** Returns the name of a measure, marked if it is planned and the table also has others. */
export const measureCell = ({ nameOf, study }: ShownResults, measure: MeasureName, tagged: boolean) => (
  <span>
    {nameOf(measure)}
    {tagged && isPlanned(measure, study.plan) && (
      <>
        {' '}
        <span class="badge" title="Its planned test is in the table above">
          planned
        </span>
      </>
    )}
  </span>
);

/** Returns the subject of a question of the paper, or an empty text for other questions. */
export const paperAboutOf = (id: string): string =>
  gameNames
    .flatMap((name) => (games[name].paperFigures ? (shippedQuestionnaires[name]?.questions ?? []) : []))
    .find((question) => question.id === id)?.about ?? '';

/** Returns a button that saves a table as `file`.csv. */
export const csvButton = (table: Table, file: string, label = 'CSV') => (
  <Button
    label={label}
    class="small"
    onClick={() => offerDownload(`${file}.csv`, 'text/csv;charset=utf-8', tidyCsv(table))}
  />
);

export const PlannedNote = () => (
  <p class="soft" role="note">
    The following results are exploratory: Holm’s p is adjusted over each table.
  </p>
);
