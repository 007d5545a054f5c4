import { cohortLookup } from '../../model/results/exported-results';
import { frameTimes } from '../../model/results/frame-times';
import { frameTimeTable } from '../../model/results/result-tables';
import { type Column, numberColumn, Table, textColumn } from '../table';
import { csvButton, fixed } from './result-cells';
import type { ShownResults } from './shown-results';

type FrameTimeRow = ReturnType<typeof frameTimes>[number];

const lateText = ({ missed, frames }: FrameTimeRow) =>
  `${missed} (${((100 * missed) / Math.max(1, frames)).toFixed(1)} %)`;

const columnsOf = ({ study, titleOf, labelOf }: ShownResults): readonly Column<FrameTimeRow>[] => [
  textColumn('Task', ({ task }) => titleOf(task)),
  textColumn('Condition', ({ condition }) => labelOf(condition)),
  ...(study.plan.cohorts ? [textColumn('Cohort', ({ cohort }: FrameTimeRow) => labelOf(cohort))] : []),
  textColumn('Stage', ({ stage }) => stage),
  numberColumn('trials', ({ trials }) => trials),
  numberColumn('frames', ({ frames }) => frames),
  numberColumn('min', ({ minMs }) => fixed(minMs, 2)),
  numberColumn('max', ({ maxMs }) => fixed(maxMs, 2)),
  numberColumn('mean', ({ meanMs }) => fixed(meanMs, 2)),
  numberColumn('worst p95', ({ worstP95Ms }) => fixed(worstP95Ms, 2), 'Largest of the trials’ 95th percentiles'),
  numberColumn('late', (row) => row.stage === 'frame' && lateText(row), 'Frames that were shown late'),
];

/** The work per frame, separately for each cohort. */
export function FrameTimes({ results }: { readonly results: ShownResults }) {
  const { study, fileOf, placeOf } = results;
  const times = frameTimes(study.records, cohortLookup(study.plan));
  const tasks = study.plan.tasks.map(({ id }) => id);
  // The whole frame stays above its stages, as `frameTimes` has them.
  const inOrder = times.toSorted(
    (a, b) =>
      Number(b.stage === 'frame') - Number(a.stage === 'frame') ||
      tasks.indexOf(a.task) - tasks.indexOf(b.task) ||
      placeOf(a.condition) - placeOf(b.condition) ||
      placeOf(a.cohort) - placeOf(b.cohort),
  );
  return (
    <>
      <h2>Frame times</h2>
      <Table
        caption="Work of the page per frame [ms] (the paper’s tables 5 and 6)"
        columns={columnsOf(results)}
        rows={inOrder}
      />
      <div class="bar">{csvButton(frameTimeTable(times, study), fileOf('frame-times'))}</div>
    </>
  );
}
