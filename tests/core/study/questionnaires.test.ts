import { describe, expect, test } from 'vitest';
import {
  checkedAnswers,
  checkedConsent,
  checkedDemographics,
  checkedDraft,
  demographicFields,
  questionnaires,
  scale,
  unanswered,
} from '../../../src/core/study/questionnaires';
import { aWomanOf26 } from './studies';

const { archery, ball } = questionnaires;

describe('the questionnaires', () => {
  test('are seven questions after archery and five after the ball game', () => {
    expect(archery.questions.map(({ id }) => id)).toEqual(['Q1', 'Q2', 'Q3', 'Q4', 'Q5', 'Q6', 'Q7']);
    expect(ball.questions.map(({ id }) => id)).toEqual(['Q8', 'Q9', 'Q10', 'Q11', 'Q12']);
  });

  test('are answered on five points from very poor to excellent', () => {
    expect(scale.map(({ value }) => value)).toEqual([1, 2, 3, 4, 5]);
    expect([scale[0].label, scale[4].label]).toEqual(['Very poor', 'Excellent']);
  });

  test('may be answered in any order, and changed', () => {
    expect(checkedDraft(ball, { Q12: 5, Q8: 1 })).toEqual({ Q12: 5, Q8: 1 });
    expect(unanswered(ball, { Q12: 5, Q8: 1 })).toEqual(['Q9', 'Q10', 'Q11']);
  });

  test.each<[Record<string, unknown>, string]>([
    [{ Q8: 0 }, 'Q8: expected a whole number from 1 to 5'],
    [{ Q8: 6 }, 'Q8: expected a whole number from 1 to 5'],
    [{ Q8: 3.5 }, 'Q8: expected a whole number from 1 to 5'],
    [{ Q8: '3' }, 'Q8: expected a whole number from 1 to 5'],
    [{ Q1: 3 }, 'Q1: the questionnaire "ball" does not ask this'],
  ])('refuse %o', (answers, message) => {
    expect(() => checkedDraft(ball, answers)).toThrow(message);
  });

  test('are complete with all questions only', () => {
    expect(() => checkedAnswers(ball, { Q8: 1, Q9: 2, Q11: 4, Q12: 5 })).toThrow('Q10: this question has no answer');
  });
});

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

describe('consent', () => {
  const given = { version: 'v1', given: true, motion: false, at: 1_800_000_000 };

  test('counts for the text that was shown', () => {
    expect(checkedConsent(given, 'v1')).toEqual(given);
    expect(() => checkedConsent(given, 'v2')).toThrow('version: consent was given to text v1, but the study shows v2');
  });

  test('is given or is none', () => {
    expect(() => checkedConsent({ ...given, given: false }, 'v1')).toThrow(
      'given: nothing is recorded without consent',
    );
  });
});
