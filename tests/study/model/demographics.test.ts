import { describe, expect, test } from 'vitest';
import { checkedDemographics, demographicFields } from '../../../src/study/model/records/demographics';
import { aWomanOf26 } from './studies';

describe('demographics', () => {
  test('are what the paper asked for, and the preferred hand', () => {
    expect(checkedDemographics(aWomanOf26)).toEqual(aWomanOf26);
    expect(demographicFields.map(({ id }) => id).toSorted()).toEqual(Object.keys(aWomanOf26).toSorted());
  });

  test('every choice of the form is accepted', () => {
    for (const field of demographicFields) {
      if (field.kind !== 'choice') continue;
      for (const { value } of field.options)
        expect(() => checkedDemographics({ ...aWomanOf26, [field.id]: value })).not.toThrow();
    }
  });

  test.each<[string, unknown]>([
    ['age', 7],
    ['age', 'twenty'],
    ['gender', 'yes'],
    ['major', '   '],
    ['major', 'x'.repeat(81)],
    ['handedness', undefined],
  ])('%s = %o is refused by name', (field, value) => {
    expect(() => checkedDemographics({ ...aWomanOf26, [field]: value })).toThrow(`${field}: `);
  });
});
