import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { type Effect, varianceAnalysis } from '../../../src/study/statistics/analysis-of-variance';
import { rankSumCounts, rankSumTest, welchTest } from '../../../src/study/statistics/between-tests';
import { noncentralF, noncentralT } from '../../../src/study/statistics/noncentral';
import { equivalenceTest, pairedTTest, signedRankTest } from '../../../src/study/statistics/paired-tests';
import { friedmanTest, kruskalWallisTest } from '../../../src/study/statistics/rank-analyses';
import { meanOf } from '../../../src/study/statistics/summaries';
import { evenly, seed } from '../../threepoint/core/arbitraries';
import { expectAsInR } from './as-in-r';
import {
  chicks,
  depression,
  grasses,
  insectSprays,
  ozone,
  placenta,
  plantGrowth,
  roundingTimes,
  sleep,
  threeRounds,
} from './data-sets';

interface InR {
  readonly f: number;
  readonly df: readonly [number, number];
  readonly p: number;
  readonly correctedP?: number;
  readonly epsilon?: number;
}

function expectEffect(ours: Effect | null, { f, df, p, correctedP, epsilon }: InR): void {
  expect(ours?.df).toEqual(df);
  expectAsInR(ours?.f, f);
  expectAsInR(ours?.p, p);
  if (correctedP !== undefined) expectAsInR(ours?.correctedP, correctedP);
  if (epsilon !== undefined) expectAsInR(ours?.epsilon, epsilon);
}

describe('two groups', () => {
  test("Welch's t-test of the sleep data: t.test(first, second)", () => {
    const result = welchTest(sleep.first, sleep.second);
    expectAsInR(result.t, -1.86081346748685);
    expectAsInR(result.df, 17.7764735161785);
    expectAsInR(result.p, 0.0793941401873582);
    expectAsInR(result.interval?.low, -3.36548323071171);
    expectAsInR(result.interval?.high, 0.20548323071171);
  });

  test("their effect in pooled standard deviations, its interval by R's pt with a noncentrality", () => {
    const { d, dInterval } = welchTest(sleep.first, sleep.second);
    expectAsInR(d, -0.832181081349539);
    expectAsInR(dInterval?.low, -1.73881689910343);
    expectAsInR(dInterval?.high, 0.0954503982114231);
  });

  test('rank sums: exact of the placenta data, by the normal approximation with ties', () => {
    const exact = rankSumTest(placenta.term, placenta.early);
    expect(exact).toMatchObject({ statistic: 35, method: 'exact' });
    expectAsInR(exact.p, 0.254412254412254);
    const tied = rankSumTest(ozone.may, ozone.august);
    expect(tied).toMatchObject({ statistic: 127.5, method: 'normal' });
    expectAsInR(tied.p, 0.000120807830768774);
    const slept = rankSumTest(sleep.first, sleep.second);
    expect(slept.statistic).toBe(25.5);
    expectAsInR(slept.p, 0.0693275754336266);
  });

  test('unequal sizes and ties: ChickWeight after 20 days, diet 2 − diet 1', () => {
    const after20 = chicks.map((members) => members.map((weights) => weights[2] as number));
    const [first = [], second = []] = after20;
    const { t, df, p, interval, d, dInterval } = welchTest(second, first);
    expectAsInR(t, 1.35508831546105);
    expectAsInR(df, 15.6215784565446);
    expectAsInR(p, 0.194661758986376);
    expectAsInR(interval?.low, -19.9689507726847);
    expectAsInR(d, 0.575117002922592);
    expectAsInR(dInterval?.high, 1.36665233343678);
    const ranks = rankSumTest(second, first);
    expect(ranks.statistic).toBe(112.5);
    expectAsInR(ranks.p, 0.175075494769451);
    expectAsInR(ranks.effectInterval?.low, -0.123031835807507);
  });

  test('the ways to choose ranks are as many as there are', () => {
    const binomial = (n: number, k: number): number => (k === 0 ? 1 : (binomial(n - 1, k - 1) * n) / k);
    for (const [m, n] of [
      [1, 1],
      [3, 4],
      [7, 5],
      [10, 12],
    ] as const) {
      const counts = rankSumCounts(m, n);
      expect(counts.reduce((sum, count) => sum + count, 0)).toBeCloseTo(binomial(m + n, m), 6);
      expect(counts).toEqual(counts.toReversed());
    }
  });

  test('complete separation: one way of all to choose their ranks, to either side', () => {
    const sides = [
      Array.from({ length: 20 }, (_, index) => index),
      Array.from({ length: 25 }, (_, index) => 100 + index),
    ];
    const [low = [], high = []] = sides;
    // wilcox.test: 6.30940535807417e-13, which is 2 / choose(45, 20).
    expectAsInR(rankSumTest(low, high).p, 6.30940535807417e-13);
    expectAsInR(rankSumTest(high, low).p, 6.30940535807417e-13);
    // And of pairs: 2 / 2 ** 30.
    const pairs = Array.from({ length: 30 }, (_, index) => 1 + index / 7);
    const none = pairs.map(() => 0);
    expectAsInR(signedRankTest(pairs, none).p, 2 ** -29);
    expectAsInR(signedRankTest(none, pairs).p, 2 ** -29);
  });

  test('say nothing where nothing spreads, and need values', () => {
    expect(welchTest([3, 3], [4, 4])).toMatchObject({ meanDifference: -1, t: null, p: null, d: null });
    expect(rankSumTest([3, 3], [3, 3])).toMatchObject({ p: null, effect: 0 });
    expect(() => welchTest([], [1])).toThrow('one of them is empty');
  });
});

test("the effect of a paired test and its interval, by R's pt: sleep", () => {
  const { d, dInterval } = pairedTTest(sleep.first, sleep.second);
  expect(d).toBeCloseTo(-1.284558, 6);
  expectAsInR(dInterval?.low, -2.11801651397707);
  expectAsInR(dInterval?.high, -0.414627756380144);
});

describe('equivalence: the larger p of R’s t.test(first, second, paired = TRUE, mu = ∓margin, alternative = …)', () => {
  test('a difference of 1.58 within 2.5 but not within 1: sleep', () => {
    const within = equivalenceTest(sleep.first, sleep.second, 2.5);
    expectAsInR(within.t, 2.36528953715916);
    expectAsInR(within.p, 0.0211168602465007);
    // t.test(…, conf.level = 0.9)
    expectAsInR(within.interval?.low, -2.29300526702928);
    expectAsInR(within.interval?.high, -0.866994732970716);
    expectAsInR(equivalenceTest(sleep.second, sleep.first, 2.5).p, 0.0211168602465007);
    const beyond = equivalenceTest(sleep.first, sleep.second, 1);
    expectAsInR(beyond.t, -1.49116079516556);
    expectAsInR(beyond.p, 0.914944114551289);
  });

  test('a positive difference, and none: depression, and answers from 1 to 5', () => {
    const changed = equivalenceTest(depression.first, depression.second, 0.8);
    expectAsInR(changed.t, 2.58713628815122);
    expectAsInR(changed.p, 0.0161281999909529);
    const first = [5, 4, 4, 5, 3, 4, 5, 4, 3, 4, 5, 4, 4, 3, 5];
    const second = [4, 4, 5, 4, 3, 4, 5, 3, 4, 4, 5, 4, 4, 4, 5];
    const alike = equivalenceTest(first, second, 0.5);
    expectAsInR(alike.p, 0.00518968887905497);
    expectAsInR(alike.interval?.high, 0.297715751029322);
  });

  test('has no t where all differences are alike', () => {
    expect(equivalenceTest([4, 5], [3, 4], 2)).toEqual({ margin: 2, interval: null, t: null, p: null });
  });
});

test('signed ranks of means of three rounds compare differences to nine digits, as R’s digits.rank = 9', () => {
  const {
    statistic: v,
    method,
    p,
    effect,
    effectInterval,
  } = signedRankTest(threeRounds.first.map(meanOf), threeRounds.second.map(meanOf));
  // R's result for the sums agrees; for the means without `digits.rank` V = 34.5, p = 0.024.
  expect([v, method]).toEqual([32, 'normal']);
  expectAsInR(p, 0.0418305945652447);
  expectAsInR(effect, 0.777777777777778);
  expectAsInR(effectInterval?.low, 0.256270691399519);
  expectAsInR(effectInterval?.high, 0.948571402369858);
});

test('an effect whose interval exceeds the computable has none, rather than a cut one', () => {
  // With two differences and t = 18 the noncentrality would reach beyond 40; computing ends at 37.
  expect(pairedTTest([19, 17], [0, 0])).toMatchObject({ t: 18, dInterval: null });
  expect(pairedTTest([8.5, 7.5], [0, 0])).toMatchObject({ t: 16, dInterval: { low: expect.any(Number) } });
  // With F(1, 2) = 512 it would reach beyond 1500; computing ends at 1400.
  const { between } = varianceAnalysis([
    [[0], [1]],
    [[16], [17]],
  ]);
  expect(between).toMatchObject({ f: 512, interval: null });
});

describe("rank-biserial correlations, their intervals by R's tanh(atanh(r) + c(-1, 1) * qnorm(.975) * error)", () => {
  test('pairs, error sqrt(n (n + 1) (2 n + 1) / 6) / (n (n + 1) / 2): depression', () => {
    const { statistic: v, effect, effectInterval } = signedRankTest(depression.first, depression.second);
    expect(v).toBe(40);
    expectAsInR(effect, 0.777777777777778);
    expectAsInR(effectInterval?.low, 0.295363129336242);
    expectAsInR(effectInterval?.high, 0.944155901920081);
  });

  test('two groups, error sqrt((m + n + 1) / (3 m n)): placenta', () => {
    const { effect, effectInterval } = rankSumTest(placenta.term, placenta.early);
    expectAsInR(effect, 0.4);
    expectAsInR(effectInterval?.low, -0.213153495960508);
    expectAsInR(effectInterval?.high, 0.787102677126454);
  });

  test('have none where all ranks are on one side', () => {
    expect(signedRankTest(sleep.first, sleep.second)).toMatchObject({ effect: -1, effectInterval: null });
    expect(rankSumTest([4, 5], [1, 2])).toMatchObject({ effect: 1, effectInterval: null });
  });
});

test("noncentral distributions are R's pt and pf", () => {
  expectAsInR(noncentralT(1.3, 7)(0.4), 0.790543299501163);
  expectAsInR(noncentralT(-2, 12)(1.5), 0.000630224900413978);
  expectAsInR(noncentralT(5, 30)(3), 0.950893731432426);
  expectAsInR(noncentralF(2.5, 3, 20)(4), 0.591930649143179);
  expectAsInR(noncentralF(0.4, 2, 42)(9), 0.00794975601529174);
});

describe('tests of more than two', () => {
  test('repeated measures, sphericity and Greenhouse and Geisser\'s correction: anova(lm(cbind(…) ~ 1), X = ~1, test = "Spherical")', () => {
    const { within, between, interaction, n } = varianceAnalysis([roundingTimes]);
    expect([n, between, interaction]).toEqual([22, null, null]);
    expectEffect(within, {
      f: 6.28830791835167,
      df: [2, 42],
      p: 0.00408410071404835,
      correctedP: 0.00843979903189373,
      epsilon: 0.773501463270562,
    });
    expectAsInR(within?.partialEtaSquared, 0.230439642398007);
    expectAsInR(within?.interval?.low, 0.0499905626442714);
    expectAsInR(within?.interval?.high, 0.373146452670905);
  });

  test('one way between participants: aov(weight ~ group, PlantGrowth)', () => {
    const { within, between } = varianceAnalysis(plantGrowth.map((values) => values.map((value) => [value])));
    expect(within).toBeNull();
    expectEffect(between, { f: 4.84608786238014, df: [2, 27], p: 0.0159099583256229 });
    expectAsInR(between?.partialEtaSquared, 0.26414829683212);
    expectAsInR(between?.interval?.low, 0.031888248130582);
    expectAsInR(between?.interval?.high, 0.428798990149255);
  });

  test('mixed, cohorts alike in size: CO2', () => {
    const { within, between, interaction } = varianceAnalysis(grasses);
    expectEffect(between, { f: 22.4867344878817, df: [1, 10], p: 0.000789697889182747 });
    expectEffect(within, {
      f: 101.32171858935,
      df: [6, 60],
      p: 1.65613201821161e-29,
      correctedP: 1.11499309118684e-10,
      epsilon: 0.314814201471423,
    });
    expectEffect(interaction, {
      f: 9.3240333168495,
      df: [6, 60],
      p: 3.23264219777969e-7,
      correctedP: 0.00174925939985155,
    });
  });

  test('mixed, cohorts of unequal size, type III: ChickWeight', () => {
    const { within, between, interaction } = varianceAnalysis(chicks);
    expectEffect(between, { f: 5.72867481212132, df: [3, 42], p: 0.00222188047648344 });
    expectEffect(within, {
      f: 337.447538427839,
      df: [2, 84],
      p: 7.11372586853184e-41,
      correctedP: 3.25825930660355e-24,
      epsilon: 0.565697411351349,
    });
    expectEffect(interaction, {
      f: 5.14215109116182,
      df: [6, 84],
      p: 0.000152320378004942,
      correctedP: 0.00261124577939712,
    });
  });

  test("by ranks: friedman.test and kruskal.test, with Kendall's W", () => {
    const friedman = friedmanTest(roundingTimes);
    expectAsInR(friedman.chiSquared, 11.1428571428571);
    expectAsInR(friedman.p, 0.00380504077551136);
    expectAsInR(friedman.effect, 0.253246753246753);
    const plants = kruskalWallisTest(plantGrowth);
    expectAsInR(plants.chiSquared, 7.98822874944372);
    expectAsInR(plants.p, 0.018423755731472);
    const insects = kruskalWallisTest(insectSprays);
    expectAsInR(insects.chiSquared, 54.6913446223714);
    expectAsInR(insects.p, 1.51084443941851e-10);
  });

  test('by ranks, so far out that the distribution is 1 to every digit: friedman.test of ChickWeight', () => {
    const weights = friedmanTest(chicks.flat());
    expectAsInR(weights.chiSquared, 92);
    expectAsInR(weights.p, 1.05306173575538e-20);
  });

  test('two conditions give the paired t-test: F is t², and the correction changes nothing', () => {
    fc.assert(
      fc.property(fc.array(fc.tuple(evenly(-5, 5), evenly(-5, 5)), { minLength: 3, maxLength: 30 }), (pairs) => {
        const { t, p } = pairedTTest(
          pairs.map(([first]) => first),
          pairs.map(([, second]) => second),
        );
        const { within } = varianceAnalysis([pairs]);
        if (t === null || p === null) return;
        expect(within?.f).toBeCloseTo(t * t, 6);
        expect(within?.p).toBeCloseTo(p, 8);
        expect(within?.epsilon).toBeCloseTo(1, 12);
      }),
      { seed },
    );
  });

  test('say nothing where nothing spreads, and need every value', () => {
    const alike = [
      [1, 2, 3],
      [2, 3, 4],
      [4, 5, 6],
    ];
    expect(varianceAnalysis([alike]).within).toMatchObject({ f: null, p: null, df: [2, 4] });
    expect(friedmanTest([[1, 1, 1]])).toMatchObject({ chiSquared: null, p: null });
    expect(() => varianceAnalysis([[[1, 2], [1]]])).toThrow('lacks a condition');
    expect(() => varianceAnalysis([[[1, 2]], []])).toThrow('no participants');
  });
});
