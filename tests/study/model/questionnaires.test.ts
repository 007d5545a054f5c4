import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import { questionKindNames } from '../../../src/study/model/questionnaires/question-kinds';
import type { QuestionnaireFile } from '../../../src/study/model/questionnaires/questionnaire-schema';
import { scaleRange, scaleScore } from '../../../src/study/model/questionnaires/questionnaire-scores';
import {
  type Answers,
  checkedAnswers,
  checkedDraft,
  type Questionnaire,
  resolvedQuestionnaire,
  shippedQuestionnaires,
  typedAnswer,
  unanswered,
} from '../../../src/study/model/questionnaires/questionnaires';

const shipped = (id: string): Questionnaire => {
  const found = shippedQuestionnaires[id];
  if (!found) throw new Error(`no questionnaire "${id}" comes with the program`);
  return found;
};
const archery = shipped('archery');
const ball = shipped('ball');

describe('the paper’s questionnaires', () => {
  test('are seven questions after archery and five after the ball game', () => {
    expect(archery.questions.map(({ id }) => id)).toEqual(['Q1', 'Q2', 'Q3', 'Q4', 'Q5', 'Q6', 'Q7']);
    expect(ball.questions.map(({ id }) => id)).toEqual(['Q8', 'Q9', 'Q10', 'Q11', 'Q12']);
  });

  test('are answered on five points from very poor to excellent', () => {
    for (const { answer } of [...archery.questions, ...ball.questions]) {
      expect(answer).toMatchObject({ kind: 'likert', from: 1, to: 5 });
      expect(answer.kind === 'likert' && [answer.labels?.[0], answer.labels?.[4]]).toEqual(['Very poor', 'Excellent']);
    }
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
    [{ Q8: Number.NaN }, 'Q8: expected'],
    [{ Q1: 3 }, 'Q1: the questionnaire "ball" does not ask this'],
  ])('refuse %o', (answers, message) => {
    expect(() => checkedDraft(ball, answers)).toThrow(message);
  });

  test('are complete with all questions only', () => {
    expect(() => checkedAnswers(ball, { Q8: 1, Q9: 2, Q11: 4, Q12: 5 })).toThrow('Q10: this question has no answer');
  });
});

const scored = (id: string, answers: Answers) => {
  const questionnaire = shipped(id);
  checkedAnswers(questionnaire, answers);
  return Object.fromEntries(questionnaire.scales.map((scale) => [scale.id, scaleScore(questionnaire, scale, answers)]));
};
const alike = (id: string, value: number): Answers =>
  Object.fromEntries(shipped(id).questions.map((question) => [question.id, value]));

describe('scores of the shipped questionnaires', () => {
  test('System Usability Scale: the example of Brooke (1996) comes to 55', () => {
    const given = [5, 4, 2, 1, 2, 3, 2, 4, 5, 2];
    const answers = Object.fromEntries(given.map((value, index) => [`U${index + 1}`, value]));
    expect(scored('system-usability', answers)).toEqual({ usability: 55 });
  });

  test('System Usability Scale: from 0, every statement at its worst, to 100', () => {
    const ends = (odd: number, even: number) =>
      Object.fromEntries(Array.from({ length: 10 }, (_, index) => [`U${index + 1}`, index % 2 === 0 ? odd : even]));
    expect(scored('system-usability', ends(1, 5))).toEqual({ usability: 0 });
    expect(scored('system-usability', ends(5, 1))).toEqual({ usability: 100 });
  });

  test('SSQ: all symptoms severe are the published maxima, and counting begins at nought', () => {
    const severe = scored('ssq', alike('ssq', 3));
    expect(severe['nausea-score']).toBeCloseTo(200.34, 9);
    expect(severe.oculomotor).toBeCloseTo(159.18, 9);
    expect(severe.disorientation).toBeCloseTo(292.32, 9);
    expect(severe.total).toBeCloseTo(235.62, 9);
    expect(scored('ssq', alike('ssq', 0))).toEqual({ 'nausea-score': 0, oculomotor: 0, disorientation: 0, total: 0 });
  });

  test('SSQ: a symptom of two clusters counts in both, and twice in the total', () => {
    const nauseous = scored('ssq', { ...alike('ssq', 0), nausea: 1 });
    expect(nauseous['nausea-score']).toBeCloseTo(9.54, 9);
    expect(nauseous.oculomotor).toBe(0);
    expect(nauseous.disorientation).toBeCloseTo(13.92, 9);
    expect(nauseous.total).toBeCloseTo(7.48, 9);
  });

  test('NASA-TLX: ratings 30, 15, 60, 40, 30, 40 with six weights give 640 / 15', () => {
    const ratings = { mental: 30, physical: 15, temporal: 60, performance: 40, frustration: 30, effort: 40 };
    const choices = {
      'mental-or-physical': 'mental',
      'mental-or-temporal': 'temporal',
      'mental-or-performance': 'mental',
      'mental-or-effort': 'mental',
      'mental-or-frustration': 'frustration',
      'physical-or-temporal': 'temporal',
      'physical-or-performance': 'performance',
      'physical-or-effort': 'effort',
      'physical-or-frustration': 'frustration',
      'temporal-or-performance': 'temporal',
      'temporal-or-effort': 'temporal',
      'temporal-or-frustration': 'temporal',
      'performance-or-effort': 'effort',
      'performance-or-frustration': 'frustration',
      'effort-or-frustration': 'effort',
    };
    const { weighted, raw } = scored('nasa-tlx', { ...ratings, ...choices });
    expect(weighted).toBeCloseTo(640 / 15, 9);
    expect(raw).toBeCloseTo(215 / 6, 9);
    expect(scored('nasa-tlx-raw', ratings).raw).toBeCloseTo(215 / 6, 9);
    expect(() => checkedDraft(shipped('nasa-tlx'), { mental: 32 })).toThrow('in steps of 5');
  });

  test('lie within the range that is stated for each', () => {
    const ranges = Object.values(shippedQuestionnaires).flatMap((one) =>
      one.scales.map(
        (scale) =>
          `${one.id} ${scale.id} ${scaleRange(one, scale)
            .map((end) => end.toFixed(2))
            .join(' to ')}`,
      ),
    );
    expect(ranges).toEqual([
      'nasa-tlx weighted 0.00 to 100.00',
      'nasa-tlx raw 0.00 to 100.00',
      'nasa-tlx-raw raw 0.00 to 100.00',
      'ssq nausea-score 0.00 to 200.34',
      'ssq oculomotor 0.00 to 159.18',
      'ssq disorientation 0.00 to 292.32',
      'ssq total 0.00 to 235.62',
      'system-usability usability 0.00 to 100.00',
    ]);
  });

  test('are none where an answer is missing', () => {
    const [scale] = shipped('nasa-tlx-raw').scales;
    if (!scale) throw new Error('expected a scale');
    expect(scaleScore(shipped('nasa-tlx-raw'), scale, { mental: 5 })).toBeNull();
  });

  test('each names its source', () => {
    for (const { source } of Object.values(shippedQuestionnaires)) expect(source?.length).toBeGreaterThan(40);
  });
});

test('the shipped kinds of questions are likert, slider, choice, number and text', () => {
  expect(questionKindNames()).toEqual(['likert', 'slider', 'choice', 'number', 'text']);
});

const file = (change: Partial<QuestionnaireFile> = {}): QuestionnaireFile => ({
  id: 'mine',
  title: 'Mine',
  answer: { kind: 'likert', from: 1, to: 7 },
  questions: [
    { id: 'a', text: 'A?' },
    { id: 'b', text: 'B?', reversed: true },
    {
      id: 'word',
      text: 'Which?',
      answer: {
        kind: 'choice',
        options: [
          { value: 'x', label: 'X' },
          { value: 'y', label: 'Y' },
        ],
      },
    },
  ],
  ...change,
});

describe('a questionnaire of one’s own', () => {
  test('is the one that docs/study.md shows: a reversed question, a comment, the mean of two answers', () => {
    const docs = readFileSync(fileURLToPath(new URL('../../../docs/study.md', import.meta.url)), 'utf8');
    const block = docs.split('```json\n').find((one) => one.includes('"questions"')) ?? '';
    const body = resolvedQuestionnaire(JSON.parse(block.slice(0, block.indexOf('```'))) as QuestionnaireFile);
    const answers = checkedAnswers(body, { mine: 6, against: 4 });
    expect(body.scales.map((scale) => [scale.id, scaleScore(body, scale, answers)])).toEqual([['embodiment', 5]]);
  });

  test('turns reversed answers round in scales, and records them as given', () => {
    const mine = resolvedQuestionnaire(
      file({ scales: [{ id: 'm', label: 'M', method: 'mean', questions: ['a', 'b'] }] }),
    );
    const answers = checkedAnswers(mine, { a: 7, b: 1, word: 'x' });
    expect(answers).toEqual({ a: 7, b: 1, word: 'x' });
    expect(mine.scales.map((scale) => scaleScore(mine, scale, answers))).toEqual([7]);
  });

  test('counts answers from a value on, as SUS (presence) does', () => {
    const mine = resolvedQuestionnaire(
      file({ scales: [{ id: 'n', label: 'N', method: 'count', atLeast: 6, questions: ['a', 'b'] }] }),
    );
    expect(mine.scales.map((scale) => scaleScore(mine, scale, { a: 6, b: 5 }))).toEqual([1]);
  });

  test.each<[string, Partial<QuestionnaireFile>, string]>([
    [
      'ends that are the wrong way round',
      { answer: { kind: 'likert', from: 7, to: 1 } },
      'answer.to: expected more than 7',
    ],
    [
      'steps that miss the end',
      { answer: { kind: 'likert', from: 0, to: 10, step: 3 } },
      'answer.step: 0 to 10 is not a whole',
    ],
    [
      'a label too few',
      { answer: { kind: 'likert', from: 1, to: 3, labels: ['a', 'b'] } },
      'answer.labels: expected 3',
    ],
    [
      'a question twice',
      {
        questions: [
          { id: 'a', text: 'A' },
          { id: 'a', text: 'B' },
        ],
      },
      'questions[1].id: "a" is the name of',
    ],
    [
      'a choice that is reversed',
      {
        questions: [{ id: 'a', text: 'A', reversed: true, answer: { kind: 'text', maxLength: 9 } }],
      },
      'questions[0].reversed: answers of the kind "text" cannot be reversed',
    ],
    [
      'a scale of a question that is not there',
      { scales: [{ id: 's', label: 'S', method: 'sum', questions: ['a', 'z'] }] },
      'scales[0].questions[1]: there is no question "z"',
    ],
    [
      'a mean of words',
      { scales: [{ id: 's', label: 'S', method: 'mean', questions: ['word'] }] },
      'scales[0].questions[0]: "word" is not answered with a number',
    ],
    [
      'a count from nowhere on',
      { scales: [{ id: 's', label: 'S', method: 'count', questions: ['a'] }] },
      'scales[0].atLeast: is missing',
    ],
  ])('with %s is refused by field', (_, change, message) => {
    expect(() => resolvedQuestionnaire(file(change))).toThrow(message);
  });

  test('with a question that nothing says how to answer is refused', () => {
    const { answer: _, ...bare } = file();
    expect(() => resolvedQuestionnaire(bare)).toThrow('questions[0].answer: is missing');
  });
});

test('a typed text is an answer as soon as it is valid', () => {
  const age = { kind: 'number', from: 16, to: 120, whole: true } as const;
  expect(typedAnswer(age, '1')).toBeNull();
  expect(typedAnswer(age, '17')).toBe(17);
  expect(typedAnswer(age, '17.5')).toBeNull();
  expect(typedAnswer({ kind: 'number', from: -1, to: 1 }, '−0,5')).toBe(-0.5);
  expect(typedAnswer({ kind: 'text', maxLength: 5 }, '  ')).toBeNull();
  expect(typedAnswer({ kind: 'text', maxLength: 5 }, ' yes ')).toBe('yes');
});

test.each(['constructor', 'toString', 'valueOf'])(
  'a question is not named "%s", under which every object has something',
  (id) => {
    const file: QuestionnaireFile = {
      id: 'mine',
      title: 'Mine',
      answer: { kind: 'likert', from: 1, to: 5 },
      questions: [{ id, text: 'How was it?' }],
    };
    expect(() => resolvedQuestionnaire(file)).toThrow(`questions[0].id: "${id}" is a reserved name`);
  },
);
