import { describe, expect, test } from 'vitest';
import { checkedPlan } from '../../../src/study/model/plan/plan';
import { compareCohorts } from '../../../src/study/model/results/compare-cohorts';
import { measuresIn, resultTables } from '../../../src/study/model/results/exported-results';
import { frameTimes } from '../../../src/study/model/results/frame-times';
import { answerMeasures } from '../../../src/study/model/results/measures';
import { rankSumTest, welchTest } from '../../../src/study/statistics/between-tests';
import { holm } from '../../../src/study/statistics/holm';
import { meanOf } from '../../../src/study/statistics/summaries';
import { chicks, plantGrowth } from '../statistics/data-sets';
import { rowsOf } from './answered';
import { latencyPlan, simulatedRecords } from './studies';

describe('two cohorts', () => {
  const ofChicks = answerMeasures(rowsOf(chicks.flat()), (participant) => {
    const cohorts = chicks.flatMap((members, index) => members.map(() => `diet-${index + 1}`));
    return cohorts[Number(participant.slice(1)) - 1] ?? '';
  });

  test('under one condition are compared by Welch and by rank sums: second treatment − control', () => {
    const measures = answerMeasures(
      rowsOf(plantGrowth.flat().map((value) => [value])),
      (participant) => ['control', 'first', 'second'][Math.floor((Number(participant.slice(1)) - 1) / 10)] ?? '',
    );
    const [compared] = compareCohorts(measures, { sides: ['second', 'control'], conditions: ['c0'] });
    const [control = [], , second = []] = plantGrowth;
    expect([compared?.first?.n, compared?.second?.n]).toEqual([10, 10]);
    expect(compared?.test).toEqual(welchTest(second, control));
    expect(compared?.ranks).toEqual(rankSumTest(second, control));
  });

  test('under one of three conditions, and by the mean of what each had under all three', () => {
    const [first = [], second = []] = chicks;
    const sides = ['diet-2', 'diet-1'] as const;
    const [last] = compareCohorts(ofChicks, { sides, conditions: ['c2'] });
    const lastOf = (members: typeof first) => members.map((weights) => weights[2] as number);
    expect(last?.test).toEqual(welchTest(lastOf(second), lastOf(first)));
    const [mean] = compareCohorts(ofChicks, { sides, conditions: ['c0', 'c1', 'c2'] });
    expect(mean?.test).toEqual(welchTest(second.map(meanOf), first.map(meanOf)));
  });

  test('a person who lacks a condition counts under the others, not in the overall mean', () => {
    const rows = rowsOf(chicks.flat()).map((row) =>
      row.participant === 'P01' && row.condition === 'c1' ? { ...row, excluded: 'voided: the phone rang' } : row,
    );
    const measures = answerMeasures(rows, (participant) => (participant < 'P18' ? 'first' : 'others'));
    const sizes = (conditions: readonly string[]) =>
      compareCohorts(measures, { sides: ['first', 'others'], conditions }).map(({ first, second }) => [
        first?.n,
        second?.n,
      ]);
    expect(sizes(['c1'])).toEqual([[16, 29]]);
    expect(sizes(['c2'])).toEqual([[17, 29]]);
    expect(sizes(['c0', 'c1', 'c2'])).toEqual([[16, 29]]);
  });

  test('means that are equal but for rounding are tied', () => {
    // 0.1 + 0.2 + 0.3 is not 0.3 + 0.2 + 0.1.
    const measures = answerMeasures(
      rowsOf([
        [0.1, 0.2, 0.3],
        [0.3, 0.2, 0.1],
      ]),
      (participant) => participant,
    );
    const compared = compareCohorts(measures, { sides: ['P01', 'P02'], conditions: ['c0', 'c1', 'c2'] });
    expect(compared).toMatchObject([{ ranks: { statistic: 0.5, effect: 0 } }]);
  });

  test('are alike where round means add up equally under all conditions: tied, without a spread', () => {
    // Three rounds under three conditions: 5/3 + 5/3 + 1 is 4/3 + 2 + 1.
    const sums = [
      [5, 5, 3],
      [4, 6, 3],
      [3, 5, 5],
      [4, 4, 5],
    ];
    const rounds = sums.map((own) => own.map((sum) => [0, 1, 2].map((round) => Math.floor((sum + round) / 3))));
    const rows = [0, 1, 2].flatMap((round) => rowsOf(rounds.map((own) => own.map((under) => under[round] as number))));
    const measures = answerMeasures(rows, (participant) => (participant < 'P03' ? 'first' : 'others'));
    const compared = compareCohorts(measures, { sides: ['first', 'others'], conditions: ['c0', 'c1', 'c2'] });
    expect(compared).toMatchObject([
      { ranks: { statistic: 2, p: null, effect: 0 }, test: { t: null, p: null, d: null } },
    ]);
  });

  test('a cohort of no one leaves means alone, no test', () => {
    const measures = answerMeasures(rowsOf([[3], [4]]), () => 'all');
    const compared = compareCohorts(measures, { sides: ['all', 'none'], conditions: ['c0'] });
    expect(compared).toMatchObject([{ first: { n: 2, mean: 3.5 }, second: null, test: null, ranks: null }]);
  });
});

describe('a mixed study', () => {
  const plan = checkedPlan(
    latencyPlan({
      participants: 12,
      cohorts: [
        { id: 'women', label: 'As a woman', avatar: 'woman' },
        { id: 'men', label: 'As a man', avatar: 'man' },
      ],
    }),
  );
  const effects = { answers: { men: 1.5 }, scores: {} };
  const records = simulatedRecords(plan, effects);
  const tables = new Map(resultTables(records, plan).map((table) => [table.name, table.rows]));

  test('compares its cohorts overall and under each condition, every view a family of its own', () => {
    const rows = tables.get('planned-cohorts') ?? [];
    expect(rows.map(({ condition, of }) => `${condition} ${of}`)).toEqual(
      ['', 'late-0', 'late-100', 'late-200'].flatMap((view) =>
        ['ownership', 'agency', 'raw'].map((of) => `${view} ${of}`),
      ),
    );
    for (const view of ['', 'late-200']) {
      const family = rows.filter(({ condition }) => condition === view);
      expect(family.map((row) => row.p_holm)).toEqual(holm(family.map((row) => row.p as number)));
    }
    expect(rows.every(({ first, second }) => first === 'men' && second === 'women')).toBe(true);
  });

  test('finds in the direction in which it was put in', () => {
    const [ownership] = tables.get('planned-cohorts') ?? [];
    expect(ownership?.ds).toBeGreaterThan(0.5);
    expect(measuresIn(records, plan).planned[0]?.cohorts.get('P01')).toMatch(/^(wo)?men$/);
  });

  test('has its scores by groups, in points and in per cent, and frame times by cohort', () => {
    const scores = tables.get('scores-cohorts') ?? [];
    expect(scores.map(({ condition, unit }) => `${condition} ${unit}`).slice(0, 4)).toEqual([
      ' points',
      ' percent',
      'late-0 points',
      'late-0 percent',
    ]);
    expect(scores.every((row) => row.n_first === 6 && row.n_second === 6)).toBe(true);
    const times = tables.get('frame-times') ?? [];
    expect(new Set(times.map(({ cohort, condition }) => `${cohort} ${condition}`)).size).toBe(6);
    const all = frameTimes(records);
    const frames = (rows: readonly { readonly frames?: unknown }[]) =>
      rows.reduce((sum, row) => sum + Number(row.frames), 0);
    expect(frames(times)).toBe(frames(all));
  });
});
