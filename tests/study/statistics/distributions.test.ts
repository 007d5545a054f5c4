import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { gammaTail, incompleteBeta, normalCdf, signedRankCdf } from '../../../src/study/statistics/distributions';
import { criticalT, twoSidedP } from '../../../src/study/statistics/summaries';
import { evenly, seed } from '../../threepoint/core/arbitraries';

/** Both values are equal to this share of the greater. */
function expectNear(ours: number, exact: number, share = 1e-12): void {
  expect(Math.abs(ours - exact)).toBeLessThanOrEqual(share * Math.max(Math.abs(ours), Math.abs(exact)));
}

describe('the incomplete beta function', () => {
  test('is a power where one parameter is 1', () => {
    fc.assert(
      fc.property(evenly(0.001, 0.999), evenly(0.1, 300), (x, power) => {
        expectNear(incompleteBeta(x, power, 1), x ** power, 1e-11);
        expectNear(incompleteBeta(x, 1, power), -Math.expm1(power * Math.log1p(-x)), 1e-11);
      }),
      { seed },
    );
  });

  test('is a sum of binomial probabilities where the parameters are whole', () => {
    const [x, n] = [0.3, 12];
    const choose = (k: number): number => (k === 0 ? 1 : (choose(k - 1) * (n - k + 1)) / k);
    for (let a = 1; a <= n; a++) {
      let sum = 0;
      for (let k = n; k >= a; k--) sum += choose(k) * x ** k * (1 - x) ** (n - k);
      expectNear(incompleteBeta(x, a, n - a + 1), sum);
    }
  });

  test('has its ends, and its mirror image', () => {
    expect([incompleteBeta(0, 2, 3), incompleteBeta(1, 2, 3)]).toEqual([0, 1]);
    expect(incompleteBeta(Number.NaN, 2, 3)).toBeNaN();
    fc.assert(
      fc.property(evenly(0.05, 0.95), evenly(0.5, 50), evenly(0.5, 50), (x, a, b) => {
        expect(incompleteBeta(x, a, b) + incompleteBeta(1 - x, b, a)).toBeCloseTo(1, 12);
      }),
      { seed },
    );
  });
});

test('the upper incomplete gamma function is a Poisson sum where its parameter is whole', () => {
  expect(gammaTail(3, 0)).toBe(1);
  expect(gammaTail(2, Number.NaN)).toBeNaN();
  fc.assert(
    fc.property(fc.integer({ min: 1, max: 20 }), evenly(0.01, 80), (a, x) => {
      let term = Math.exp(-x);
      let sum = 0;
      for (let k = 0; k < a; k++) {
        sum += term;
        term *= x / (k + 1);
      }
      expectNear(gammaTail(a, x), sum, 1e-11);
    }),
    { seed },
  );
});

test('the normal distribution has the probabilities of its tables, far into its tails', () => {
  expect(normalCdf(0)).toBe(0.5);
  for (const [z, p] of [
    [1.959963984540054, 0.975],
    [-1.2815515655446004, 0.1],
    [-5, 2.866515718791939e-7],
    [-10, 7.619853024160525e-24],
    [-30, 4.906713927148187e-198],
  ] as const)
    expectNear(normalCdf(z), p, 1e-11);
});

describe("Student's t", () => {
  test('has its closed forms for one and two degrees of freedom', () => {
    for (const t of [0, 0.1, 1, 4, 60]) {
      expectNear(twoSidedP(t, 1), 1 - (2 * Math.atan(t)) / Math.PI, 1e-10);
      expectNear(twoSidedP(-t, 2), 1 - t / Math.sqrt(2 + t * t), 1e-10);
    }
  });

  test('lies with its share between ± the critical value', () => {
    fc.assert(
      fc.property(evenly(0.5, 0.999), fc.integer({ min: 1, max: 500 }), (confidence, df) => {
        expectNear(twoSidedP(criticalT(confidence, df), df), 1 - confidence, 1e-10);
      }),
      { seed },
    );
  });
});

test("the distribution of Wilcoxon's V counts the sums of ranks", () => {
  // The eight sums of three ranks: 0, 1, 2, 3, 3, 4, 5, 6.
  expect([-1, 0, 1, 2, 3, 4, 5, 6].map((v) => 8 * signedRankCdf(v, 3))).toEqual([0, 1, 2, 3, 5, 6, 7, 8]);
  // The printed critical value of 10 pairs is at 5 %, two-sided.
  expect(signedRankCdf(8, 10)).toBe(25 / 1024);
});
