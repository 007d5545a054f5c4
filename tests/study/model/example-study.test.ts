import { describe, expect, test } from 'vitest';
import { checkedPlan, languagesOf, participantsOf, type StudyPlan } from '../../../src/study/model/plan/plan';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { resumed } from '../../../src/study/model/progress/progress';
import { questionKindNames } from '../../../src/study/model/questionnaires/question-kinds';
import { checkedRecord, type StudyRecord } from '../../../src/study/model/records/study-record';
import { answersIn, scalesIn, studyTables } from '../../../src/study/model/tables/study-tables';
import { compareAnswers } from './answered';
import { completed, examplePlan, paperPlan, planWith, session, simulatedRecords } from './studies';

/** The registered kinds of questions as the messages list them. */
const kinds = new Intl.ListFormat('en-GB', { type: 'disjunction' }).format(questionKindNames());

const plan = examplePlan();
const given = {
  mine: 6,
  strange: 2,
  delay: 37,
  watched: 'arms',
  guess: 3,
  remarks: 'The bow shook, a little.',
} as const;

/** Returns a participant with this language and these answers to the first questionnaire. */
function answered(answers: Readonly<Record<string, number | string>>, language = 'de') {
  const one = session(scheduleFor(plan, 'P01'));
  expect(one.tell({ type: 'consent', version: plan.consent.version, motion: false, language })).toBeNull();
  one.doUntil(({ kind }) => kind === 'questionnaire');
  for (const [question, value] of Object.entries(answers)) {
    expect(one.tell({ type: 'answer', question, value })).toBeNull();
  }
  return one;
}

const bodyOf = (records: readonly StudyRecord[]) => {
  const last = records.at(-1);
  if (last?.kind !== 'answers') throw new Error('expected answers');
  return last;
};

describe('a study with questions of every kind', () => {
  test('asks its questionnaires one after the other after each block', () => {
    const { steps } = scheduleFor(plan, 'P01');
    const asked = steps.flatMap((step) => (step.kind === 'questionnaire' ? [[step.id, step.questionnaire.id]] : []));
    expect(asked).toEqual([
      ['archery/1/questionnaire', 'body'],
      ['archery/1/questionnaire-2', 'nasa-tlx-raw'],
      ['archery/2/questionnaire', 'body'],
      ['archery/2/questionnaire-2', 'nasa-tlx-raw'],
    ]);
  });

  test('records answers as given, with the language they were read in, and the store takes them', () => {
    const one = answered(given);
    expect(one.tell({ type: 'submit' })).toBeNull();
    const record = bodyOf(one.records);
    expect(record.body).toMatchObject({ questionnaire: 'body', language: 'de', answers: given });
    expect(checkedRecord(JSON.parse(JSON.stringify(record)), plan)).toEqual(record);
    expect(() => checkedRecord(record, {})).toThrow('body.questionnaire: the study has no questionnaire "body"');
  });

  test('goes on after a reload with text, choice and number as they were', () => {
    const one = answered(given);
    one.progress = resumed(scheduleFor(plan, 'P01'), JSON.stringify(one.progress));
    expect(one.progress.draft).toEqual(given);
    expect(one.progress.language).toBe('de');
  });

  test('takes an answer back, and wants it again unless it may stay open', () => {
    const one = answered(given);
    expect(one.tell({ type: 'answer', question: 'remarks', value: null })).toBeNull();
    expect(one.tell({ type: 'answer', question: 'guess', value: null })).toBeNull();
    expect(one.tell({ type: 'submit' })).toBe('guess: this question has no answer');
    expect(one.tell({ type: 'answer', question: 'guess', value: 0 })).toBeNull();
    expect(one.tell({ type: 'submit' })).toBeNull();
    expect(bodyOf(one.records).body.answers).not.toHaveProperty('remarks');
  });

  test.each<[string, number | string, string]>([
    ['mine', 8, 'from 1 to 7'],
    ['delay', 101, 'from 0 to 100'],
    ['watched', 'feet', 'expected one of hands, arms, target, other'],
    ['guess', 2.5, 'expected a whole number from 0 to 4'],
    ['remarks', 'x'.repeat(201), 'at most 200 characters'],
  ])('refuses %s = %o', (question, value, complaint) => {
    expect(answered({}).tell({ type: 'answer', question, value })).toContain(complaint);
  });

  test('becomes tables: answers as numbers or text, scales computed, words in both languages', () => {
    const one = answered(given);
    one.tell({ type: 'submit' });
    one.doUntil(({ kind }) => kind === 'end');
    const tables = new Map(studyTables(one.records, plan).map((table) => [table.name, table.rows]));
    const rows = tables.get('answers')?.filter(({ questionnaire, block }) => questionnaire === 'body' && block === 1);
    expect(rows?.map(({ question, answer, answer_text }) => [question, answer, answer_text])).toEqual([
      ['mine', 6, ''],
      ['strange', 2, ''],
      ['delay', 37, ''],
      ['watched', null, 'arms'],
      ['guess', 3, ''],
      ['remarks', null, 'The bow shook, a little.'],
    ]);
    const [embodiment] = tables.get('scales') ?? [];
    expect(embodiment).toMatchObject({ questionnaire: 'body', scale: 'embodiment', value: 6 });
    expect(tables.get('participants')?.[0]).toMatchObject({ language: 'de' });
    const words = tables.get('questions')?.filter(({ question }) => question === 'guess');
    expect(words?.map(({ language, answers }) => [language, answers])).toEqual([
      ['en', '0 to 4 targets'],
      ['de', '0 to 4 Ziele'],
    ]);
  });

  test('is compared by question and by scale, what has no number left out', () => {
    const simulated = { ...plan, id: 'example-simulated', participants: 12 };
    const records = simulatedRecords(simulated);
    for (const record of records) checkedRecord(JSON.parse(JSON.stringify(record)), simulated);
    const named = (rows: Parameters<typeof compareAnswers>[0]) =>
      compareAnswers(rows, ['learned', 'hands-only']).comparisons.map(
        ({ of, values }) => `${of} ${values.first.length}`,
      );
    expect(named(answersIn(records, simulated))).toEqual(
      [
        'mine',
        'strange',
        'delay',
        'guess',
        'mental',
        'physical',
        'temporal',
        'performance',
        'effort',
        'frustration',
      ].map((of) => `${of} 12`),
    );
    expect(named(scalesIn(records, simulated))).toEqual(['embodiment 12', 'raw 12']);
  });

  test('a question asked after two tasks is two comparisons, each named by its task', () => {
    const [task] = plan.tasks as [StudyPlan['tasks'][number]];
    const twice = checkedPlan({ ...plan, participants: 2, tasks: [task, { ...task, id: 'again', title: 'Again' }] });
    const records = participantsOf(twice).flatMap((participant) => completed(participant, { plan: twice }));
    const { comparisons } = compareAnswers(answersIn(records, twice), ['learned', 'hands-only']);
    expect(comparisons.map(({ of }) => of)).toContain('archery/body/mine');
    expect(comparisons.map(({ of }) => of)).toContain('again/body/mine');
  });
});

describe('a plan with a mistake in its questionnaires', () => {
  test.each<[string, string, unknown, string]>([
    [
      'a name that no questionnaire has',
      'tasks.0.questionnaire',
      ['body', 'nasa'],
      'tasks[0].questionnaire[1]: there is no questionnaire "nasa": expected one of body, archery, ball, nasa-tlx',
    ],
    [
      'the same one twice after a block',
      'tasks.0.questionnaire',
      ['body', 'body'],
      'tasks[0].questionnaire[1]: "body" is the name of tasks[0].questionnaire[0] too',
    ],
    [
      'the name of a shipped one',
      'questionnaires.0.id',
      'ssq',
      'questionnaires[0].id: "ssq" is the name of a questionnaire that comes with the program',
    ],
    [
      'a text that one language lacks',
      'questionnaires.0.questions.2.answer.ends.high.de',
      undefined,
      'questionnaires[0].questions[2].answer.ends.high.de: is missing, and the study is in this language too',
    ],
    ['a consent that one language lacks', 'consent.paragraphs.0.de', undefined, 'consent.paragraphs[0].de: is missing'],
    [
      'a title that one language lacks',
      'tasks.0.title.de',
      undefined,
      'tasks[0].title.de: is missing, and the study is in this language too',
    ],
    [
      'an unknown kind of answer',
      'questionnaires.0.answer.kind',
      'stars',
      `questionnaires[0].answer.kind: expected ${kinds}`,
    ],
    ['a language that is none', 'languages.1', 'Deutsch!', 'languages[1]: expected a language, as "en"'],
    [
      'a misspelt field',
      'questionnaires.0.questions.1.reverse',
      true,
      'questionnaires[0].questions[1].reverse: is not known here',
    ],
  ])('%s is refused by field', (_, path, value, message) => {
    expect(() => checkedPlan(planWith(plan, path, value))).toThrow(message);
  });

  test('a plan that says nothing of languages is in one', () => {
    expect(languagesOf(paperPlan())).toEqual(['en']);
  });
});
