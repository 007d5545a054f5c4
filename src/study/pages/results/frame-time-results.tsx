import { element } from 'threepoint-ui';
import { cohortLookup } from '../../model/results/exported-results';
import { frameTimes } from '../../model/results/frame-times';
import { frameTimeTable } from '../../model/results/result-tables';
import { tableNode } from '../table';
import { bar, csvButton, fixed } from './result-cells';
import type { ShownResults } from './shown-results';

const frameTimeHeads = [
  { text: 'Task' },
  { text: 'Condition' },
  { text: 'Cohort' },
  { text: 'Stage' },
  { text: 'trials', numeric: true },
  { text: 'frames', numeric: true },
  { text: 'min', numeric: true },
  { text: 'max', numeric: true },
  { text: 'mean', numeric: true },
  { text: 'worst p95', numeric: true, title: 'Largest of the trials’ 95th percentiles' },
  { text: 'late', numeric: true, title: 'Frames that were shown late' },
] as const;

/** Returns the work per frame, separately for each cohort. */
export function frameTimeParts({ study, titleOf, labelOf, fileOf }: ShownResults): readonly Node[] {
  const { plan, records } = study;
  const times = frameTimes(records, cohortLookup(plan));
  const several = plan.cohorts !== undefined;
  const lateText = (missed: number, frames: number) =>
    `${missed} (${((100 * missed) / Math.max(1, frames)).toFixed(1)} %)`;
  return [
    element('h2', {}, 'Frame times'),
    tableNode(
      'Work of the page per frame [ms] (the paper’s tables 5 and 6)',
      frameTimeHeads.filter(({ text }) => several || text !== 'Cohort'),
      times.map((row) => ({
        cells: [
          titleOf(row.task),
          labelOf(row.condition),
          ...(several ? [labelOf(row.cohort)] : []),
          row.stage,
          String(row.trials),
          String(row.frames),
          fixed(row.minMs, 2),
          fixed(row.maxMs, 2),
          fixed(row.meanMs, 2),
          fixed(row.worstP95Ms, 2),
          row.stage === 'frame' ? lateText(row.missed, row.frames) : '',
        ],
      })),
    ),
    bar(csvButton(frameTimeTable(times, study), fileOf('frame-times'))),
  ];
}
