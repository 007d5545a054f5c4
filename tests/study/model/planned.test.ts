import { expect, test } from 'vitest';
import { checkedPlan } from '../../../src/study/model/plan/plan';
import { remarksOn } from '../../../src/study/model/plan/plan-remarks';
import { compareConditions } from '../../../src/study/model/results/compare-conditions';
import { measuresIn, overallComparisons, resultTables } from '../../../src/study/model/results/exported-results';
import { holm } from '../../../src/study/statistics/holm';
import { examplePlan, latencyPlan, simulatedRecords } from './studies';

const plan = latencyPlan({ participants: 6 });
const effects = { answers: { 'late-200': -1 }, scores: {} };
const records = simulatedRecords(plan, effects);
const measures = measuresIn(records, plan);

test('a plan’s named questions are a family: Holm applies to them alone, whatever else was asked', () => {
  const { answers, scales, planned } = measures;
  expect(answers.length + scales.length).toBeGreaterThan(15);
  const family = compareConditions(planned, ['late-200', 'late-0'], plan).comparisons;
  expect(family.map(({ of }) => of)).toEqual(['ownership', 'agency', 'raw']);
  expect(family.map(({ holmP }) => holmP)).toEqual(holm(family.map(({ test }) => test?.p ?? null)));
  const analyses = overallComparisons(planned, plan);
  expect(analyses.map(({ of }) => of)).toEqual(['ownership', 'agency', 'raw']);
  expect(analyses.map(({ holmP }) => holmP)).toEqual(
    holm(analyses.map(({ variance }) => variance?.within?.correctedP ?? null)),
  );
});

test('the tables of an export hold the planned Holm p and mark everything else as explored', () => {
  const tables = new Map(resultTables(records, plan).map((table) => [table.name, table.rows]));
  const planned = tables.get('planned-compared') ?? [];
  expect(planned.map(({ of, first, second }) => `${of} ${first} ${second}`)).toEqual(
    ['late-100 late-0', 'late-200 late-0', 'late-200 late-100'].flatMap((pair) =>
      ['ownership', 'agency', 'raw'].map((of) => `${of} ${pair}`),
    ),
  );
  const explored = tables.get('scales-compared') ?? [];
  expect(explored.filter((row) => row.planned).map(({ of }) => of)).toEqual([
    'ownership',
    'agency',
    'raw',
    'ownership',
    'agency',
    'raw',
    'ownership',
    'agency',
    'raw',
  ]);
  expect(tables.get('answers-compared')?.every((row) => row.planned === false)).toBe(true);
  expect(tables.get('scores-compared')?.every((row) => row.planned === false)).toBe(true);
  // One test, adjusted over three and over four.
  const raw = (rows: typeof planned) => rows.find(({ of, first }) => of === 'raw' && first === 'late-200');
  expect(raw(planned)?.p).toBe(raw(explored)?.p);
  expect(raw(planned)?.low_dz).toBe(raw(explored)?.low_dz);
  expect(raw(planned)?.p_holm).not.toBe(raw(explored)?.p_holm);
  expect(tables.get('planned-overall')).toHaveLength(3);
});

test('a planned score is of points', () => {
  const scored = { ...plan, planned: ['archery/score'] };
  expect(measuresIn(records, scored).planned.map(({ of, unit }) => `${of} ${unit}`)).toEqual(['archery points']);
  const [, overall] = resultTables(records, scored);
  expect(overall).toMatchObject({ name: 'planned-overall', rows: [{ of: 'archery', unit: 'points', planned: true }] });
});

test('without planned measures nothing is planned', () => {
  const { planned: _, ...unplanned } = plan;
  expect(measuresIn(records, unplanned).planned).toEqual([]);
});

test('a measure that is nowhere is named', () => {
  const wrong = { ...plan, planned: ['archery/score', 'archery/embodiment/soul'] };
  expect(() => checkedPlan(wrong)).toThrow('planned[1]: "archery/embodiment/soul" is not measured');
});

test('an experimenter learns that a planned question by choice or words suits no test', () => {
  const named = [
    'archery/body/watched',
    'archery/body/guess',
    'archery/body/embodiment',
    'archery/body/remarks',
    'archery/score',
  ];
  const plan = checkedPlan({ ...examplePlan(), planned: named });
  expect(remarksOn(plan)).toEqual([
    'Planned "archery/body/watched" is not answered with a number and will not be tested.',
    'Planned "archery/body/remarks" is not answered with a number and will not be tested.',
  ]);
});
