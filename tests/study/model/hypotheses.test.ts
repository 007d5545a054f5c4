import { describe, expect, test } from 'vitest';
import { plannedMeasures } from '../../../src/study/model/plan/hypotheses';
import { checkedPlan, type StudyPlan } from '../../../src/study/model/plan/plan';
import { remarksOn } from '../../../src/study/model/plan/plan-remarks';
import { compareConditions } from '../../../src/study/model/results/compare-conditions';
import { measuresIn, resultTables } from '../../../src/study/model/results/exported-results';
import { plannedTable } from '../../../src/study/model/tables/plan-tables';
import { holm } from '../../../src/study/statistics/holm';
import { equivalenceTest } from '../../../src/study/statistics/paired-tests';
import { simulatedPower } from '../../../src/study/statistics/power';
import { paperPlan, planWith, simulatedRecords, threeBodiesPlan } from './studies';

const plan = paperPlan();
const effects = { answers: { paper: 0.2 }, scores: {} };
const records = simulatedRecords(plan, effects, 3);
const measures = measuresIn(records, plan);
const compared = compareConditions(measures.planned, ['paper', 'ik'], plan).comparisons;

describe('the hypotheses of the paper’s plan', () => {
  test('test the questions by which the paper decides each of them', () => {
    const questions = (plan.hypotheses ?? []).map(({ id, measures }) => [
      id,
      ...measures.map((one) => one.split('/').at(-1)),
    ]);
    // Sections 6.1 and 6.2 of the paper.
    expect(questions).toEqual([
      ['H1', 'Q4', 'Q6', 'Q10', 'Q11'],
      ['H2', 'Q1', 'Q2', 'Q8', 'Q9'],
      ['H3', 'Q5', 'score'],
    ]);
  });

  test('make their measures planned, whether or not the plan names more', () => {
    expect(measures.planned.map(({ of }) => of).toSorted()).toEqual([
      'Q1',
      'Q10',
      'Q11',
      'Q2',
      'Q4',
      'Q5',
      'Q6',
      'Q8',
      'Q9',
      'ball',
    ]);
    const named = ['archery/score', 'archery/archery/Q1'];
    expect(plannedMeasures({ ...plan, planned: named })).toHaveLength(11);
  });

  test('have tests of equivalence where they state a margin, and Holm’s p over these alone', () => {
    const margins = compared.map(({ of, equivalence }) => [of, equivalence?.margin]);
    expect(Object.fromEntries(margins)).toMatchObject({ Q1: 0.5, Q11: 0.5, Q5: undefined, ball: undefined });
    const within = compared.filter(({ equivalence }) => equivalence !== null);
    expect(within.map(({ equivalenceHolmP }) => equivalenceHolmP)).toEqual(
      holm(within.map(({ equivalence }) => equivalence?.p ?? null)),
    );
    expect(compared.map(({ holmP }) => holmP)).toEqual(holm(compared.map(({ test }) => test?.p ?? null)));
  });

  test('stand in the table of planned comparisons of an export, with their tests', () => {
    const tables = new Map(resultTables(records, plan).map((table) => [table.name, table]));
    const rows = tables.get('planned-compared')?.rows ?? [];
    for (const { of, hypothesis, equivalence, equivalenceHolmP } of compared) {
      expect(rows.find((row) => row.of === of)).toMatchObject({
        hypothesis: hypothesis?.id,
        margin: hypothesis?.margin ?? null,
        t_equivalence: equivalence?.t ?? null,
        low_equivalence: equivalence?.interval?.low ?? null,
        p_equivalence_holm: equivalenceHolmP,
      });
    }
    const explored = tables.get('answers-compared')?.columns.map(({ name }) => name) ?? [];
    expect(explored.filter((name) => name.includes('equivalence'))).toEqual([]);
  });

  test('have a row for each measure in the table of planned measures', () => {
    const rows = plannedTable(plan).rows;
    expect(rows).toHaveLength(10);
    expect(rows.at(-1)).toMatchObject({
      measure: 'ball/score',
      hypothesis: 'H3',
      first: 'paper',
      second: 'ik',
      margin: null,
    });
    expect(plannedTable({ planned: ['ball/score'] }).rows).toMatchObject([{ hypothesis: '', margin: null }]);
  });
});

describe('the plan of three bodies', () => {
  const bodies = threeBodiesPlan();

  test('balances every order of its four conditions in both games', () => {
    expect(bodies.conditions.map(({ estimator }) => estimator)).toEqual(['hands-only', 'ik', 'paper', 'learned']);
    expect(remarksOn(bodies)).toEqual([]);
  });

  // Half a point is 0.55 of 0.9 points, the largest standard deviation of differences that the paper's t imply.
  test.each([
    ['a difference of half a standard deviation', { effect: 0.5 }],
    ['equivalence of equal conditions within half a point', { effect: 0, margin: 0.55 }],
  ])('shows with a power of 0.8 at the smallest level of Holm: %s', (_, planned) => {
    const alpha = 0.05 / plannedMeasures(bodies).length;
    const power = simulatedPower({ design: 'paired', alpha, ...planned }, bodies.participants, {
      seed: 1,
      studies: 4000,
    });
    expect(power.t).toBeGreaterThan(0.8);
    expect(power.wilcoxon ?? 1).toBeGreaterThan(0.8);
  });

  test('tests equivalence only under the conditions of a hypothesis', () => {
    const participants = { ...bodies, participants: 12 };
    const drawn = simulatedRecords(participants, effects);
    const { planned } = measuresIn(drawn, participants);
    const claims = (first: string, second: string) =>
      compareConditions(planned, [first, second], bodies).comparisons.map(({ hypothesis, equivalence }) => [
        hypothesis?.id,
        equivalence?.margin,
      ]);
    const all = (id: string) => [
      [id, 0.5],
      [id, 0.5],
      [id, 0.5],
      [id, 0.5],
    ];
    expect(claims('paper', 'ik')).toEqual(all('B4'));
    // The order of the sides does not matter.
    expect(claims('ik', 'paper')).toEqual(all('B4'));
    expect(claims('ik', 'hands-only').map(([id]) => id)).toEqual(['B1', undefined, 'B1', undefined]);
  });
});

describe('a hypothesis that cannot be tested is refused with its field', () => {
  test.each<[string, string, unknown, string]>([
    [
      'an unknown condition',
      'hypotheses.0.conditions',
      ['paper', 'mocap'],
      'conditions[1]: there is no condition "mocap"',
    ],
    ['a condition against itself', 'hypotheses.0.conditions', ['ik', 'ik'], 'conditions: compares "ik" with itself'],
    ['an unknown measure', 'hypotheses.0.measures.1', 'ball/ball/Q13', 'measures[1]: "ball/ball/Q13" is not measured'],
    ['a measure named twice', 'hypotheses.0.measures.1', 'archery/archery/Q4', 'measures[1]: "archery/archery/Q4" is'],
    [
      'a measure of another hypothesis',
      'hypotheses.1.measures.0',
      'ball/ball/Q10',
      'measures[0]: "ball/ball/Q10" is a measure of H1 too',
    ],
    ['a margin of 0', 'hypotheses.0.margin', 0, 'margin: expected a number from 0.001'],
    ['an id for two', 'hypotheses.1.id', 'H1', 'id: "H1" is the name of'],
  ])('%s', (_, path, value, message) => {
    expect(() => checkedPlan(planWith(plan, path, value) as StudyPlan)).toThrow(message);
  });
});

test('a difference as large as the margin passes as equivalent in one of twenty studies', () => {
  const alike = { design: 'paired', effect: 0.5, margin: 0.5, alpha: 0.05 } as const;
  const { t } = simulatedPower(alike, 40, { seed: 9, studies: 10_000 });
  expect(Math.abs(t - 0.05)).toBeLessThan(0.007);
});

test('the sides of a test of equivalence can be exchanged', () => {
  const sides = [
    [5, 4, 4, 3],
    [4, 4, 5, 4],
  ] as const;
  const forth = equivalenceTest(sides[0], sides[1], 1);
  const back = equivalenceTest(sides[1], sides[0], 1);
  expect(back.p).toBe(forth.p);
  expect(back.interval?.low).toBeCloseTo(-(forth.interval?.high ?? NaN), 12);
});
