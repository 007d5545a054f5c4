import type { AnswerRow } from 'threepoint-study/model/tables/answer-tables';

/** One question answered under conditions c0, c1 … by P01, P02 …. */
export const rowsOf = (participants: readonly (readonly number[])[]): readonly AnswerRow[] =>
  participants.flatMap((values, index) =>
    values.map((answer, at) => ({
      participant: `P${String(index + 1).padStart(2, '0')}`,
      simulated: false,
      task: 'archery',
      block: at + 1,
      run: 1,
      condition: `c${at}`,
      questionnaire: 'body',
      question: 'mine',
      answer,
      excluded: '',
    })),
  );
