import { checkedPlan } from 'threepoint-study/model/plan/plan';
import { type CohortComparison, compareCohorts } from 'threepoint-study/model/results/compare-cohorts';
import { measuresIn, resultTables } from 'threepoint-study/model/results/exported-results';
import { frameTimes } from 'threepoint-study/model/results/frame-times';
import { answerMeasures } from 'threepoint-study/model/results/measures';
import { modelsWith, simulateStudy } from 'threepoint-study/simulation/simulate-study';
import { holm } from 'threepoint-study/statistics/holm';
import { describe, expect, test } from 'vitest';
import { expectAsInR } from '../statistics/as-in-r';
import { chicks, plantGrowth } from '../statistics/data-sets';
import { rowsOf } from './answered';
import { latencyPlan } from './studies';

/**
 * R's figures: t.test(a, b), wilcox.test(a, b); d_s by pooled standard deviations, its interval by uniroot and pt with
 * a noncentrality.
 */
interface InR {
  readonly t: number;
  readonly df: number;
  readonly p: number;
  readonly interval: readonly [number, number];
  readonly ds: number;
  readonly dsInterval: readonly [number, number];
  readonly w: number;
  readonly ranksP: number;
  readonly r: number;
  readonly rInterval: readonly [number, number];
}

function expectComparison(ours: CohortComparison | undefined, r: InR): void {
  const { test: welch, rankSum } = ours ?? {};
  expectAsInR(welch?.t, r.t);
  expectAsInR(welch?.df, r.df);
  expectAsInR(welch?.p, r.p);
  expectAsInR(welch?.interval?.low, r.interval[0]);
  expectAsInR(welch?.interval?.high, r.interval[1]);
  expectAsInR(welch?.ds, r.ds);
  expectAsInR(welch?.dsInterval?.low, r.dsInterval[0]);
  expectAsInR(welch?.dsInterval?.high, r.dsInterval[1]);
  expect(rankSum?.w).toBe(r.w);
  expectAsInR(rankSum?.p, r.ranksP);
  expectAsInR(rankSum?.effect, r.r);
  expectAsInR(rankSum?.effectInterval?.low, r.rInterval[0]);
  expectAsInR(rankSum?.effectInterval?.high, r.rInterval[1]);
}

describe('two cohorts', () => {
  const ofChicks = answerMeasures(rowsOf(chicks.flat()), (participant) => {
    const cohorts = chicks.flatMap((members, index) => members.map(() => `diet-${index + 1}`));
    return cohorts[Number(participant.slice(1)) - 1] ?? '';
  });

  test('under one condition: PlantGrowth, second treatment − control', () => {
    const measures = answerMeasures(
      rowsOf(plantGrowth.flat().map((value) => [value])),
      (participant) => ['control', 'first', 'second'][Math.floor((Number(participant.slice(1)) - 1) / 10)] ?? '',
    );
    const [compared] = compareCohorts(measures, { cohorts: ['second', 'control'], conditions: ['c0'] });
    expect([compared?.first?.n, compared?.second?.n]).toEqual([10, 10]);
    expectComparison(compared, {
      t: 2.13402045312406,
      df: 16.7857644826057,
      p: 0.0478992556019693,
      interval: [0.00512786996464084, 0.982872130035359],
      ds: 0.954362959712061,
      dsInterval: [0.0130716398648099, 1.87220297548466],
      w: 75,
      ranksP: 0.0630128385546342,
      r: 0.5,
      rInterval: [0.030738729305766, 0.788655074576659],
    });
  });

  test('of unequal size under one of three conditions, with ties: ChickWeight after 20 days, diet 2 − diet 1', () => {
    const [compared] = compareCohorts(ofChicks, { cohorts: ['diet-2', 'diet-1'], conditions: ['c2'] });
    expectComparison(compared, {
      t: 1.35508831546105,
      df: 15.6215784565446,
      p: 0.194661758986376,
      interval: [-19.9689507726847, 90.3454214209199],
      ds: 0.575117002922592,
      dsInterval: [-0.227420355802338, 1.36665233343678],
      w: 112.5,
      ranksP: 0.175075494769451,
      r: 0.323529411764706,
      rInterval: [-0.123031835807507, 0.661134599026972],
    });
  });

  test('by the mean of what each had under all three', () => {
    const [compared] = compareCohorts(ofChicks, { cohorts: ['diet-2', 'diet-1'], conditions: ['c0', 'c1', 'c2'] });
    expectComparison(compared, {
      t: 1.36449332252439,
      df: 15.1216454823022,
      p: 0.192375185099345,
      interval: [-8.56441027907556, 39.0977436124089],
      ds: 0.585297707371216,
      dsInterval: [-0.217892740485663, 1.37730671051349],
      w: 108.5,
      ranksP: 0.248091196624873,
      r: 0.276470588235294,
      rInterval: [-0.173609494445217, 0.6310138197542],
    });
  });

  test('who lacks a condition counts under the others, and not in the mean of all', () => {
    const rows = rowsOf(chicks.flat()).map((row) =>
      row.participant === 'P01' && row.condition === 'c1' ? { ...row, excluded: 'voided: the phone rang' } : row,
    );
    const measures = answerMeasures(rows, (participant) => (participant < 'P18' ? 'first' : 'others'));
    const sizes = (conditions: readonly string[]) =>
      compareCohorts(measures, { cohorts: ['first', 'others'], conditions }).map(({ first, second }) => [
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
    const compared = compareCohorts(measures, { cohorts: ['P01', 'P02'], conditions: ['c0', 'c1', 'c2'] });
    expect(compared).toMatchObject([{ rankSum: { w: 0.5, effect: 0 } }]);
  });

  test('are alike where the means of their rounds add up to the same under all conditions: tied, and without a spread', () => {
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
    const compared = compareCohorts(measures, { cohorts: ['first', 'others'], conditions: ['c0', 'c1', 'c2'] });
    expect(compared).toMatchObject([{ rankSum: { w: 2, p: null, effect: 0 }, test: { t: null, p: null, ds: null } }]);
  });

  test('of whom one has no one: means alone, no test', () => {
    const measures = answerMeasures(rowsOf([[3], [4]]), () => 'all');
    const compared = compareCohorts(measures, { cohorts: ['all', 'none'], conditions: ['c0'] });
    expect(compared).toMatchObject([{ first: { n: 2, mean: 3.5 }, second: null, test: null, rankSum: null }]);
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
  const models = modelsWith(plan, { answers: { men: 1.5 }, scores: {} });
  const records = simulateStudy(plan, models, 5, 1e9).flatMap((one) => one.records);
  const tables = new Map(resultTables(records, plan).map((table) => [table.name, table.rows]));

  test('compares its cohorts by the mean of all conditions and under each, every view a family of its own', () => {
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
