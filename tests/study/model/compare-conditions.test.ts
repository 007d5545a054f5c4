import { describe, expect, test } from 'vitest';
import { ordersByGroup } from '../../../src/study/model/plan/allocation';
import { questionnairesOf, type StudyTask } from '../../../src/study/model/plan/plan';
import type { AnswerRow, TrialRow } from '../../../src/study/model/tables/study-tables';
import { drawAnswers, drawPerson } from '../../../src/study/simulation/answer-model';
import { randomSource } from '../../../src/study/simulation/random-source';
import { signedRankTest } from '../../../src/study/statistics/paired-tests';
import { threeRounds } from '../statistics/data-sets';
import { compareAnswers, compareScores } from './answered';
import { paperPlan } from './studies';

/**
 * The answers of fifteen participants to all twelve questions, under both conditions in counterbalanced order; `effect`
 * [points] is that of the paper's condition, on one question or on all.
 */
function simulatedAnswers(study: number, effect = 0, only?: string): AnswerRow[] {
  const plan = paperPlan({ seed: study });
  const orders = ordersByGroup(plan, plan.tasks[0] as StudyTask);
  const random = randomSource(study, 'answers');
  return orders.flatMap((order, index) => {
    const person = drawPerson(random);
    return order.flatMap(({ id: condition }) =>
      questionnairesOf(plan).flatMap((questionnaire) =>
        questionnaire.questions.flatMap((question) => {
          const isAffected = condition === 'paper' && (only === undefined || only === question.id);
          const asked = { ...questionnaire, questions: [question] };
          const drawn = drawAnswers(asked, person, isAffected ? effect : 0, random);
          return {
            participant: `P${String(index + 1).padStart(2, '0')}`,
            simulated: true,
            task: questionnaire.id,
            condition,
            questionnaire: questionnaire.id,
            question: question.id,
            answer: drawn[question.id] as number,
            excluded: '',
          };
        }),
      ),
    );
  });
}

describe('an analysis of simulated studies', () => {
  const findings = (study: number, p: 'holmP' | 'ranksHolmP') =>
    compareAnswers(simulatedAnswers(study)).comparisons.filter((comparison) => (comparison[p] ?? 1) < 0.05).length;

  test('finds nothing in at least 95 of 100 studies in which there is nothing', { tags: ['full'] }, () => {
    for (const p of ['holmP', 'ranksHolmP'] as const) {
      const silent = Array.from({ length: 100 }, (_, study) => findings(study, p)).filter(
        (found) => found === 0,
      ).length;
      expect(silent, p).toBeGreaterThanOrEqual(95);
    }
  });

  test('finds an effect of 1.5 points in most questions of every study, in its direction', () => {
    for (let study = 0; study < 20; study++) {
      const { comparisons } = compareAnswers(simulatedAnswers(study, 1.5));
      const found = comparisons.filter(({ holmP }) => (holmP ?? 1) < 0.05);
      expect(found.length).toBeGreaterThan(6);
      for (const { test: tested } of found) expect(tested?.t).toBeGreaterThan(0);
    }
  });

  test('finds an effect in the one question that has it', () => {
    for (let study = 0; study < 20; study++) {
      const { comparisons } = compareAnswers(simulatedAnswers(study, 2, 'Q9'));
      const strongest = comparisons.toSorted((a, b) => (a.test?.p ?? 1) - (b.test?.p ?? 1))[0];
      expect(strongest?.of).toBe('Q9');
      expect(strongest?.holmP).toBeLessThan(0.05);
    }
  });
});

describe('a comparison', () => {
  const answer = (participant: string, condition: string, value: number, excluded = ''): AnswerRow => ({
    participant,
    simulated: false,
    task: 'archery',
    condition,
    questionnaire: 'archery',
    question: 'Q1',
    answer: value,
    excluded,
  });

  test('is of people who answered under both conditions, and names others with the reason', () => {
    const { comparisons, excluded } = compareAnswers([
      answer('P01', 'paper', 5),
      answer('P01', 'ik', 3),
      answer('P02', 'paper', 4),
      answer('P03', 'paper', 4),
      answer('P03', 'ik', 1, 'voided: battery'),
      answer('P04', 'paper', 4),
      answer('P04', 'ik', 4),
    ]);
    expect(comparisons[0]?.values).toEqual({ first: [5, 4], second: [3, 4] });
    expect(excluded).toEqual([
      { participant: 'P03', of: 'Q1', reason: 'voided: battery' },
      { participant: 'P02', of: 'Q1', reason: 'no valid value under "ik"' },
      { participant: 'P03', of: 'Q1', reason: 'no valid value under "ik"' },
    ]);
  });

  test('is never of people with simulated people', () => {
    expect(() => compareAnswers([answer('P01', 'ik', 3), { ...answer('P02', 'ik', 3), simulated: true }])).toThrow(
      'must not be mixed',
    );
  });

  test("has a group's score once, though each member reports it", () => {
    const trial = (participant: string, group: number, condition: string, score: number): TrialRow => ({
      participant,
      simulated: false,
      task: 'ball',
      condition,
      repetition: 1,
      group,
      score,
      maximum: 20,
      excluded: '',
    });
    const rows = [1, 2, 3, 4, 5].flatMap((group) =>
      ['a', 'b', 'c'].flatMap((member) => [
        trial(`${member}${group}`, group, 'paper', 14 + group),
        trial(`${member}${group}`, group, 'ik', 13 + (group % 3)),
      ]),
    );
    const { points, percent } = compareScores(rows);
    expect(points.comparisons[0]?.values.first).toHaveLength(5);
    expect(points.comparisons[0]?.test?.df).toBe(4);
    expect(points.comparisons[0]?.first?.mean).toBe(17);
    expect(percent.comparisons[0]?.first?.mean).toBeCloseTo(85, 9);
    expect(percent.comparisons[0]?.test?.t).toBeCloseTo(points.comparisons[0]?.test?.t as number, 9);
  });

  test('has no t where all differences of means of three answers are alike', () => {
    const answers = [4, 5, 6, 8].flatMap((sum, index) =>
      [0, 1, 2].flatMap((round) => {
        const part = Math.floor((sum + round) / 3);
        return [answer(`P${index}`, 'ik', part), answer(`P${index}`, 'paper', part + (round === 0 ? 1 : 0))];
      }),
    );
    const [compared] = compareAnswers(answers).comparisons;
    expect(compared?.test?.meanDifference).toBeCloseTo(1 / 3, 9);
    expect(compared?.test).toMatchObject({ t: null, p: null, d: null, interval: null });
  });

  test('has the signed ranks of its sums when means of rounds are compared, in any unit', () => {
    const trial = (condition: string, rounds: readonly (readonly number[])[]) =>
      rounds.flatMap((own, index) =>
        own.map(
          (score, round): TrialRow => ({
            participant: `P${index + 1}`,
            simulated: false,
            task: 'archery',
            condition,
            repetition: round + 1,
            group: index + 1,
            score,
            maximum: 70,
            excluded: '',
          }),
        ),
      );
    const rows = [...trial('paper', threeRounds.first), ...trial('ik', threeRounds.second)];
    const sums = (rounds: readonly (readonly number[])[]) =>
      rounds.map((own) => own.reduce((sum, score) => sum + score, 0));
    const right = signedRankTest(sums(threeRounds.first), sums(threeRounds.second));
    expect(right).toMatchObject({ statistic: 32, method: 'normal' });
    const { points, percent } = compareScores(rows);
    expect(points.comparisons[0]?.ranks).toEqual(right);
    expect(percent.comparisons[0]?.ranks).toEqual(right);
  });
});
