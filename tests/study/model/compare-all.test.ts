import { expect, test } from 'vitest';
import { compareAll } from '../../../src/study/model/results/compare-all';
import { answerMeasures } from '../../../src/study/model/results/measures';
import { chicks, plantGrowth, roundingTimes } from '../statistics/data-sets';
import { rowsOf } from './answered';

const three = ['c0', 'c1', 'c2'];

test('three conditions are compared as R does, and who lacks one is left out and named', () => {
  const rows = rowsOf(roundingTimes);
  const [compared] = compareAll(answerMeasures(rows), three);
  expect(compared).toMatchObject({ of: 'mine', n: 22, leftOut: [] });
  expect(compared?.variance?.within?.correctedP).toBeCloseTo(0.00843979903189373, 9);
  expect(compared?.holmP).toBe(compared?.variance?.within?.correctedP);
  expect(compared?.ranks?.p).toBeCloseTo(0.00380504077551136, 9);
  const voided = rows.map((row) =>
    row.participant === 'P03' && row.condition === 'c1' ? { ...row, excluded: 'voided: the phone rang' } : row,
  );
  expect(compareAll(answerMeasures(voided), three)).toMatchObject([{ n: 21, leftOut: ['P03'] }]);
});

test('cohorts of unequal size under three conditions are a mixed design', () => {
  const cohorts = chicks.flatMap((members, index) => members.map(() => `cohort-${index}`));
  const cohortOf = (participant: string) => cohorts[Number(participant.slice(1)) - 1] ?? '';
  const [compared] = compareAll(answerMeasures(rowsOf(chicks.flat()), cohortOf), three);
  expect(compared?.variance?.between?.p).toBeCloseTo(0.00222188047648344, 9);
  expect(compared?.variance?.interaction?.correctedP).toBeCloseTo(0.00261124577939712, 9);
});

test('cohorts under one condition are compared with each other', () => {
  const cohortOf = (participant: string) => `cohort-${Math.floor((Number(participant.slice(1)) - 1) / 10)}`;
  const rows = rowsOf(plantGrowth.flat().map((value) => [value]));
  const [compared] = compareAll(answerMeasures(rows, cohortOf), ['c0']);
  expect(compared?.variance?.between?.p).toBeCloseTo(0.0159099583256229, 9);
  expect(compared?.holmP).toBe(compared?.variance?.between?.p);
  expect(compared?.ranks?.p).toBeCloseTo(0.018423755731472, 9);
});

test('people and simulated ones are never compared together', () => {
  const rows = rowsOf(roundingTimes);
  const mixed = rows.map((row, index) => ({ ...row, simulated: index === 0 }));
  expect(() => answerMeasures(mixed)).toThrow('must not be mixed');
});
