import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { rankSumTest } from '../../../src/study/statistics/between-tests';
import { signedRankTest } from '../../../src/study/statistics/paired-tests';
import { friedmanTest, kruskalWallisTest } from '../../../src/study/statistics/rank-analyses';
import { ranksOf } from '../../../src/study/statistics/ranks';
import { meanOf } from '../../../src/study/statistics/summaries';
import { seed } from '../../threepoint/core/arbitraries';

type Rounds = readonly number[];

const sumOf = (values: Rounds) => values.reduce((sum, value) => sum + value, 0);

/** Scores in steps of 5 of 4 to 24 people under three conditions, k rounds each: [person][condition][round]. */
const played = (k: number): fc.Arbitrary<readonly (readonly Rounds[])[]> => {
  const rounds = fc.array(
    fc.integer({ min: 0, max: 10 }).map((steps) => 5 * steps),
    { minLength: k, maxLength: k },
  );
  return fc.array(fc.tuple(rounds, rounds, rounds), { minLength: 4, maxLength: 24 });
};

const under = (people: readonly (readonly Rounds[])[], condition: number): readonly Rounds[] =>
  people.map((own) => own[condition] as Rounds);

const halves = <T>(people: readonly T[]) => {
  const middle = people.length >> 1;
  return [people.slice(0, middle), people.slice(middle)] as const;
};

/** Ranks know no unit: a test of means must be that of the sums, which are whole numbers, in every figure. */
describe.each([2, 3, 4, 5, 6, 7])('the ranks of means of %i values are those of their sums', (k) => {
  const always = (alike: (people: readonly (readonly Rounds[])[]) => void) =>
    fc.assert(fc.property(played(k), alike), { seed, numRuns: 200 });

  test('in signed ranks: n, zeros, V, method, p, effect and its interval', () => {
    always((people) => {
      const [first, second] = [under(people, 0), under(people, 1)];
      expect(signedRankTest(first.map(meanOf), second.map(meanOf))).toEqual(
        signedRankTest(first.map(sumOf), second.map(sumOf)),
      );
    });
  });

  test('in rank sums of cohorts, by the mean of what each had under three conditions', () => {
    always((people) => {
      const [first, second] = halves(people);
      const mean = (own: readonly Rounds[]) => meanOf(own.map(meanOf));
      const sum = (own: readonly Rounds[]) => sumOf(own.map(sumOf));
      expect(rankSumTest(first.map(mean), second.map(mean))).toEqual(rankSumTest(first.map(sum), second.map(sum)));
    });
  });

  test("in Friedman's test, of scales of three items that are asked so many times", () => {
    always((people) => {
      const mean = (rounds: Rounds) => meanOf(rounds.map((score) => score / 3));
      expect(friedmanTest(people.map((own) => own.map(mean)))).toEqual(
        friedmanTest(people.map((own) => own.map(sumOf))),
      );
    });
  });

  test("in Kruskal and Wallis's test of three cohorts", () => {
    always((people) => {
      const cohorts = [people.slice(0, 1), people.slice(1, 3), people.slice(3)];
      const mean = (own: readonly Rounds[]) => meanOf(own.map(meanOf));
      const sum = (own: readonly Rounds[]) => sumOf(own.map(sumOf));
      expect(kruskalWallisTest(cohorts.map((members) => members.map(mean)))).toEqual(
        kruskalWallisTest(cohorts.map((members) => members.map(sum))),
      );
    });
  });
});

describe('ranks', () => {
  test('are shared by what differs in the last digits alone, as 0.1 + 0.2 and 0.3 do', () => {
    expect(ranksOf([0.3, 7, 0.1 + 0.2, -1])).toEqual({ ranks: [2.5, 4, 2.5, 1], ties: [2] });
  });

  test('tell apart what differs by a millionth of the largest', () => {
    expect(ranksOf([100, 0.0002, 0.0001, 0.0003])).toEqual({ ranks: [4, 2, 1, 3], ties: [] });
  });

  test('pairs that differ by rounding alone are left out, however little the others differ', () => {
    const { zeros, n, statistic } = signedRankTest([50.1 + 0.2, 50.1, 50.2], [50.3, 50, 50]);
    expect([zeros, n, statistic]).toEqual([1, 2, 3]);
  });
});
