import { expect, test } from 'vitest';
import { checkedPlan, type StudyTask } from '../../../src/study/model/plan/plan';
import { compareConditions } from '../../../src/study/model/results/compare-conditions';
import { scaleCharts } from '../../../src/study/pages/results/comparison-figures';
import { shownResults } from '../../../src/study/pages/results/shown-results';
import { latencyPlan, simulatedRecords } from '../model/studies';

test('two tasks with like questions stand side by side in a figure, each with its id', () => {
  const [task] = latencyPlan().tasks as [StudyTask];
  const { planned: _, ...unplanned } = latencyPlan({ participants: 6, tasks: [task, { ...task, id: 'archery-far' }] });
  const plan = checkedPlan(unplanned);
  const records = simulatedRecords(plan);
  const results = shownResults({ plan, simulated: true, records });
  const { scales, points } = results.measures;
  const compared = (measures: typeof scales) => compareConditions(measures, ['late-200', 'late-0'], plan).comparisons;
  const charts = scaleCharts({
    results,
    between: false,
    labels: { first: '200 ms', second: '0 ms' },
    order: ['second', 'first'],
    ...{ answers: [], scales: compared(scales), points: [], percent: [], planned: [] },
  });
  for (const { comparisons, nameOf } of charts) {
    expect(comparisons.map(nameOf)).toEqual(['Archery (archery)', 'Archery (archery-far)']);
  }
  expect(points.map(results.nameOf)).toEqual(['Archery (archery), points', 'Archery (archery-far), points']);
});
