import { compareConditions } from '../../../src/study/model/results/compare-conditions';
import { answerMeasures, scoreMeasures } from '../../../src/study/model/results/measures';
import type { AnswerRow, TrialRow } from '../../../src/study/model/tables/study-tables';

/** One question answered under conditions c0, c1 … by P01, P02 …. */
export const rowsOf = (participants: readonly (readonly number[])[]): readonly AnswerRow[] =>
  participants.flatMap((values, index) =>
    values.map((answer, at) => ({
      participant: `P${String(index + 1).padStart(2, '0')}`,
      simulated: false,
      task: 'archery',
      condition: `c${at}`,
      questionnaire: 'body',
      question: 'mine',
      answer,
      excluded: '',
    })),
  );

const sides = ['paper', 'ik'] as const;

/** Compares every question or scale with numeric answers under two conditions. */
export const compareAnswers = (rows: readonly AnswerRow[], conditions: readonly [string, string] = sides) =>
  compareConditions(answerMeasures(rows), conditions, {});

/** Compares the scores of every task under the paper's network and IK, in points and, apart from them, in per cent. */
export const compareScores = (rows: readonly TrialRow[]) => ({
  points: compareConditions(scoreMeasures(rows, 'points'), sides, {}),
  percent: compareConditions(scoreMeasures(rows, 'percent'), sides, {}),
});
