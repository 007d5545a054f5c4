import { type ButtonHTMLAttributes, h, toChildArray, type VNode } from 'preact';
import * as v from 'valibot';
import { afterEach, beforeEach, describe, expect, test } from 'vitest';
import { planJsonSchema } from '../../../src/study/cli/check/plan-json-schema';
import { inLanguage, words } from '../../../src/study/model/phrases/localized-text';
import { phrasesOf } from '../../../src/study/model/phrases/phrases';
import { checkedPlan, type StudyPlan } from '../../../src/study/model/plan/plan';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { begin } from '../../../src/study/model/progress/progress';
import type { Answer, QuestionKind } from '../../../src/study/model/questionnaires/question-kind';
import { questionKindNames, registerQuestionKind } from '../../../src/study/model/questionnaires/question-kinds';
import type { Question } from '../../../src/study/model/questionnaires/questionnaire-schema';
import { checkedRecord } from '../../../src/study/model/records/study-record';
import { measuresIn } from '../../../src/study/model/results/exported-results';
import { answersIn, studyTables } from '../../../src/study/model/tables/study-tables';
import { questionTargets } from '../../../src/study/participant/questions/question-sheet';
import type { QuestionView } from '../../../src/study/participant/questions/question-view';
import { questionView, registerQuestionView } from '../../../src/study/participant/questions/question-views';
import { questionPart } from '../../../src/study/participant/screens/question-screen';
import type { ShownSession } from '../../../src/study/participant/screens/study-situation';
import { paperPlan, session, simulatedRecords } from '../model/studies';
import agreement from '../question-kinds/agreement.mjs';

// A laboratory adds a kind of question from outside the package: agreement, which is 1 or 0.

declare module '../../../src/study/model/questionnaires/question-kind' {
  interface AnswerForms {
    agreement: { readonly kind: 'agreement'; readonly yes: string; readonly no: string };
  }
}

const [archery] = paperPlan().tasks as [StudyPlan['tasks'][number]];
const plan = (): StudyPlan =>
  paperPlan({
    tasks: [{ ...archery, questionnaire: 'presence' }],
    questionnaires: [
      {
        id: 'presence',
        title: 'Presence',
        answer: { kind: 'agreement', yes: 'I agree', no: 'I disagree' },
        questions: [
          { id: 'body', text: 'Was it your body?' },
          { id: 'other', text: 'Was it another body?', reversed: true },
        ],
        scales: [{ id: 'owned', label: 'Ownership', method: 'sum', questions: ['body', 'other'] }],
      },
    ],
    planned: ['archery/presence/owned'],
  });

/** Shows the first question of the plan with this answer; `choose` receives what is pressed. */
function shown(answer: Answer | undefined, choose: (value: Answer) => void) {
  const schedule = scheduleFor(plan(), 'P01');
  const step = schedule.steps.find(({ kind }) => kind === 'questionnaire');
  if (step?.kind !== 'questionnaire') throw new Error('expected a questionnaire');
  const draft = answer === undefined ? {} : { body: answer };
  const session: Pick<ShownSession, 'progress' | 'phrases'> = {
    progress: { ...begin(schedule), draft },
    phrases: phrasesOf(plan(), 'en'),
  };
  return questionPart(
    step.questionnaire.questions as readonly Question[],
    0,
    {
      session: session as ShownSession,
      questionnaire: { question: 0, typed: null, triedToSubmit: false },
      rejection: null,
    },
    { goTo: () => undefined, choose: (_, value) => choose(value), type: () => undefined },
  ).question;
}

describe('a kind of question that is registered from outside', () => {
  // reason: the module is JavaScript, as a laboratory may write it
  const added = agreement({ v, words, inLanguage, h });
  const [kind] = added.questionKinds as unknown as [QuestionKind];
  const [view] = added.questionViews as unknown as [QuestionView];
  let remove: (() => void)[] = [];
  beforeEach(() => {
    remove = [registerQuestionKind(kind), registerQuestionView(view)];
  });
  afterEach(() => {
    for (const one of remove) one();
  });

  test('is accepted in plans, and its forms are checked by field', () => {
    expect(checkedPlan(plan()).questionnaires).toHaveLength(1);
    const [presence] = plan().questionnaires as [NonNullable<StudyPlan['questionnaires']>[number]];
    const wrong = { ...presence, answer: { kind: 'agreement', yes: 'I agree' } };
    expect(() => checkedPlan({ ...plan(), questionnaires: [wrong] })).toThrow(
      'questionnaires[0].answer.no: is missing',
    );
  });

  test('is in the JSON schema of plans', () => {
    expect(JSON.stringify(planJsonSchema())).toContain('"const":"agreement"');
  });

  test('is refused in plans once it is removed', () => {
    for (const one of [...remove, ...remove]) one();
    expect(questionKindNames()).not.toContain('agreement');
    expect(() => checkedPlan(plan())).toThrow(/answer\.kind: expected (?!.*agreement)/);
    const schema = JSON.stringify(planJsonSchema());
    expect(schema).not.toContain('agreement');
    expect(schema).toContain('"const":"text"');
  });

  test('is registered once', () => {
    expect(() => registerQuestionKind(kind)).toThrow('"agreement" is registered already');
    expect(() => registerQuestionView(view)).toThrow('"agreement" has a view already');
  });

  test('is answered on the desk card, which shows the answer', () => {
    const chosen: Answer[] = [];
    const { id, field, phrases } = shown(0, (value) => chosen.push(value));
    const buttons = toChildArray(questionView(field).card(field, id, phrases)) as VNode<ButtonHTMLAttributes>[];
    expect(buttons.map(({ props }) => [props.children, props['aria-pressed']])).toEqual([
      ['I agree', false],
      ['I disagree', true],
    ]);
    for (const { props } of buttons) (props.onClick as () => void)();
    expect(chosen).toEqual([1, 0]);
  });

  test('is answered on the VR sheet, which shows the answer', () => {
    const chosen: Answer[] = [];
    const targets = questionTargets(shown(1, (value) => chosen.push(value)));
    const options = targets.filter(({ kind }) => kind === 'option');
    expect(options.map(({ label, look }) => [label, look])).toEqual([
      ['I agree', 'chosen'],
      ['I disagree', 'plain'],
    ]);
    options[1]?.act();
    expect(chosen).toEqual([0]);
  });

  test('is recorded by its answer schema', () => {
    const one = session(scheduleFor(plan(), 'P01'));
    one.doUntil(({ kind }) => kind === 'questionnaire');
    expect(one.tell({ type: 'answer', question: 'body', value: 2 })).toBe('body: expected 1 or 0');
    one.doUntil(({ kind }) => kind === 'rest');
    const record = one.records.find(({ kind }) => kind === 'answers');
    if (record?.kind !== 'answers') throw new Error('expected answers');
    expect(checkedRecord(record, plan())).toEqual(record);
    const wrong = { ...record, body: { ...record.body, answers: { body: 1, other: 'no' } } };
    expect(() => checkedRecord(wrong, plan())).toThrow('body.answers.other: expected 1 or 0');
  });

  test('is simulated, tabulated, scored and compared', () => {
    const records = simulatedRecords(plan());
    const questions = studyTables(records, plan()).find(({ name }) => name === 'questions');
    expect(questions?.rows[0]).toMatchObject({ kind: 'agreement', answers: '1: I agree; 0: I disagree' });
    expect(questions?.columns.find(({ name }) => name === 'kind')?.values).toContain('agreement');
    const answers = answersIn(records, plan());
    expect(new Set(answers.map(({ answer }) => answer))).toEqual(new Set([0, 1]));
    const { answers: measures, scales } = measuresIn(records, plan());
    expect(measures.map(({ of }) => of)).toEqual(['body', 'other']);
    expect(scales.map(({ of }) => of)).toEqual(['owned']);
  });
});
