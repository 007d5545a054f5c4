import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { holm } from '../../../src/study/statistics/holm';
import { pairedTTest, signedRankTest } from '../../../src/study/statistics/paired-tests';
import { meanSummary } from '../../../src/study/statistics/summaries';
import { number, seed } from '../../threepoint/core/arbitraries';
import { depression, sleep } from './data-sets';

describe('the paired t-test', () => {
  test('agrees with R on its sleep data', () => {
    const result = pairedTTest(sleep.first, sleep.second);
    // t = -4.0621, df = 9, p-value = 0.002833, 95 percent confidence interval: -2.4598858 -0.7001142, mean difference:
    // -1.58
    expect(result.t).toBeCloseTo(-4.0621, 4);
    expect(result.df).toBe(9);
    expect(result.p).toBeCloseTo(0.002833, 6);
    expect(result.interval?.low).toBeCloseTo(-2.4598858, 7);
    expect(result.interval?.high).toBeCloseTo(-0.7001142, 7);
    expect(result.meanDifference).toBeCloseTo(-1.58, 12);
  });

  test('gives the effect in standard deviations of the differences: t / √n', () => {
    const { t, df, d } = pairedTTest(sleep.first, sleep.second);
    expect(d).toBeCloseTo((t as number) / Math.sqrt((df as number) + 1), 12);
    expect(d).toBeCloseTo(-1.284558, 6);
  });

  test('turns its sign, and nothing else, with the pairs', () => {
    const forth = pairedTTest(sleep.first, sleep.second);
    const back = pairedTTest(sleep.second, sleep.first);
    expect(back.t).toBeCloseTo(-(forth.t as number), 12);
    expect(back.p).toBeCloseTo(forth.p as number, 12);
  });

  test('says nothing where all differences are alike', () => {
    expect(pairedTTest([4, 5, 3], [3, 4, 2])).toMatchObject({ meanDifference: 1, t: null, p: null, d: null });
    expect(pairedTTest([4, 5, 3], [4, 5, 3])).toMatchObject({ meanDifference: 0, t: null, p: null });
    expect(pairedTTest([0.3, 0.6], [0.1, 0.4])).toMatchObject({ t: null, p: null });
    expect(pairedTTest([4], [3])).toMatchObject({ df: 0, t: null, p: null });
  });

  test('needs pairs', () => {
    expect(() => pairedTTest([1, 2], [1])).toThrow('2 of the first kind, 1 of the second');
    expect(() => pairedTTest([], [])).toThrow('there are none');
  });
});

describe("Wilcoxon's signed-rank test", () => {
  test('agrees with R on its sleep data, where a zero and ties call for the approximation', () => {
    const result = signedRankTest(sleep.first, sleep.second);
    // V = 0, p-value = 0.009091
    expect(result).toMatchObject({ statistic: 0, n: 9, zeros: 1, method: 'normal', effect: -1 });
    expect(result.p).toBeCloseTo(0.009091, 6);
  });

  test("agrees with R's exact test of Hollander and Wolfe's patients", () => {
    const result = signedRankTest(depression.first, depression.second);
    // V = 40; R prints p = 0.01953 one-sided.
    expect(result).toMatchObject({ statistic: 40, n: 9, zeros: 0, method: 'exact' });
    expect(result.p).toBeCloseTo(2 * 0.01953125, 10);
  });

  test('is exact by counting: of 2^n ways to give signs, those as far out', () => {
    fc.assert(
      fc.property(
        fc.integer({ min: 1, max: 10 }),
        fc.array(fc.boolean(), { minLength: 10, maxLength: 10 }),
        (n, signs) => {
          const differences = Array.from({ length: n }, (_, index) => (signs[index] ? 1 : -1) * (index + 1));
          const { statistic: v, p } = signedRankTest(differences, new Array(n).fill(0));
          const middle = (n * (n + 1)) / 4;
          let extreme = 0;
          for (let ways = 0; ways < 2 ** n; ways++) {
            let sum = 0;
            for (let rank = 1; rank <= n; rank++) if (ways & (1 << (rank - 1))) sum += rank;
            if (Math.abs(sum - middle) >= Math.abs(v - middle)) extreme += 1;
          }
          expect(p).toBeCloseTo(extreme / 2 ** n, 10);
        },
      ),
      { seed },
    );
  });

  test('approximates what it could count: the same forty-nine pairs, with one more that does not differ', () => {
    const differences = Array.from({ length: 49 }, (_, index) => (index % 3 === 0 ? -1 : 1) * (index + 1));
    const counted = signedRankTest(differences, new Array(49).fill(0));
    const approximate = signedRankTest([...differences, 0], new Array(50).fill(0));
    expect(counted.method).toBe('exact');
    expect(approximate).toMatchObject({ method: 'normal', statistic: counted.statistic, n: 49 });
    expect(Math.abs((counted.p as number) - (approximate.p as number))).toBeLessThan(0.001);
  });

  test('says nothing where no pair differs', () => {
    expect(signedRankTest([3, 4], [3, 4])).toMatchObject({ n: 0, zeros: 2, p: null, effect: null });
  });

  test('is certain of nothing where V lies in the middle', () => {
    expect(signedRankTest([1, -1, 2, -2], [0, 0, 0, 0]).p).toBe(1);
  });
});

describe("Holm's correction", () => {
  test('agrees with R', () => {
    // p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm"): 0.03 0.06 0.06 0.02
    expect(holm([0.01, 0.04, 0.03, 0.005]).map((p) => Number((p as number).toFixed(12)))).toEqual([
      0.03, 0.06, 0.06, 0.02,
    ]);
  });

  test('counts tests without a p in the family, but not those that were not made', () => {
    expect(holm([0.01, null, null])).toEqual([0.03, null, null]);
    expect(holm([0.01, undefined, 0.02])).toEqual([0.02, null, 0.02]);
  });

  test('never makes a p smaller, never more than 1, and keeps their order', () => {
    fc.assert(
      fc.property(fc.array(number(0, 1), { minLength: 1, maxLength: 20 }), (pValues) => {
        const adjusted = holm(pValues) as number[];
        pValues.forEach((p, i) => {
          expect(adjusted[i]).toBeGreaterThanOrEqual(p);
          expect(adjusted[i]).toBeLessThanOrEqual(1);
          pValues.forEach((other, j) => {
            if (p < other) expect(adjusted[i]).toBeLessThanOrEqual(adjusted[j] as number);
          });
        });
      }),
      { seed },
    );
  });
});

describe('a mean', () => {
  test('has the interval of R', () => {
    // t.test(sleep$extra[1:10]): mean of x 0.75, 95 percent confidence interval: -0.5297804 2.0297804
    const { mean, interval } = meanSummary(sleep.first);
    expect(mean).toBeCloseTo(0.75, 12);
    expect(interval?.low).toBeCloseTo(-0.5297804, 7);
    expect(interval?.high).toBeCloseTo(2.0297804, 7);
  });

  test('a single value has none', () => {
    expect(meanSummary([4])).toEqual({ n: 1, mean: 4, standardDeviation: null, interval: null });
  });
});
