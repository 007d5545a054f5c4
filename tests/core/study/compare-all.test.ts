import { expect, test } from 'vitest';
import type { AnswerRow } from '../../../src/core/study/answer-tables';
import { compareAll } from '../../../src/core/study/compare-all';
import { chicks, plantGrowth, roundingTimes } from '../statistics/data-sets';

/** One question answered under conditions c0, c1 … by P01, P02 …. */
const rowsOf = (participants: readonly (readonly number[])[]): readonly AnswerRow[] =>
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

const three = ['c0', 'c1', 'c2'];
const alike = () => '';

test('three conditions are compared as R does, and who lacks one is left out and named', () => {
  const rows = rowsOf(roundingTimes);
  const [compared] = compareAll(rows, { conditions: three, cohortOf: alike });
  expect(compared).toMatchObject({ of: 'mine', n: 22, leftOut: [] });
  expect(compared?.variance?.within?.correctedP).toBeCloseTo(0.00843979903189373, 9);
  expect(compared?.holmP).toBe(compared?.variance?.within?.correctedP);
  expect(compared?.ranks?.p).toBeCloseTo(0.00380504077551136, 9);
  const voided = rows.map((row) =>
    row.participant === 'P03' && row.condition === 'c1' ? { ...row, excluded: 'voided: the phone rang' } : row,
  );
  expect(compareAll(voided, { conditions: three, cohortOf: alike })).toMatchObject([{ n: 21, leftOut: ['P03'] }]);
});

test('cohorts of unequal size under three conditions are a mixed design', () => {
  const cohorts = chicks.flatMap((members, index) => members.map(() => `cohort-${index}`));
  const [compared] = compareAll(rowsOf(chicks.flat()), {
    conditions: three,
    cohortOf: (participant) => cohorts[Number(participant.slice(1)) - 1] ?? '',
  });
  expect(compared?.variance?.between?.p).toBeCloseTo(0.00222188047648344, 9);
  expect(compared?.variance?.interaction?.correctedP).toBeCloseTo(0.00261124577939712, 9);
});

test('cohorts under one condition are compared with each other', () => {
  const [compared] = compareAll(rowsOf(plantGrowth.flat().map((value) => [value])), {
    conditions: ['c0'],
    cohortOf: (participant) => `cohort-${Math.floor((Number(participant.slice(1)) - 1) / 10)}`,
  });
  expect(compared?.variance?.between?.p).toBeCloseTo(0.0159099583256229, 9);
  expect(compared?.holmP).toBe(compared?.variance?.between?.p);
  expect(compared?.ranks?.p).toBeCloseTo(0.018423755731472, 9);
});

test('people and simulated ones are never compared together', () => {
  const rows = rowsOf(roundingTimes);
  const mixed = rows.map((row, index) => ({ ...row, simulated: index === 0 }));
  expect(() => compareAll(mixed, { conditions: three, cohortOf: alike })).toThrow('must not be mixed');
});
