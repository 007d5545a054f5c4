import { text } from 'threepoint/core/validation/validation';
import { planJsonSchema } from 'threepoint-study/cli/check/plan-json-schema';
import { phrasesOf } from 'threepoint-study/model/phrases/phrases';
import { checkedPlan, type StudyPlan } from 'threepoint-study/model/plan/plan';
import { scheduleFor } from 'threepoint-study/model/plan/schedule';
import { begin } from 'threepoint-study/model/progress/progress';
import type { Answer, QuestionKind } from 'threepoint-study/model/questionnaires/question-kind';
import { questionKindNames, registerQuestionKind } from 'threepoint-study/model/questionnaires/question-kinds';
import type { Question } from 'threepoint-study/model/questionnaires/questionnaire-schema';
import { checkedRecord } from 'threepoint-study/model/records/study-record';
import { measuresIn } from 'threepoint-study/model/results/exported-results';
import { answersIn, studyTables } from 'threepoint-study/model/tables/study-tables';
import { questionNodes } from 'threepoint-study/participant/questions/question-card';
import { questionPart } from 'threepoint-study/participant/questions/question-screen';
import { questionTargets } from 'threepoint-study/participant/questions/question-sheet';
import type { QuestionView } from 'threepoint-study/participant/questions/question-view';
import { registerQuestionView } from 'threepoint-study/participant/questions/question-views';
import type { ShownSession } from 'threepoint-study/participant/study-situation';
import { nullAnswerModel } from 'threepoint-study/simulation/answer-model';
import { statedPerformanceModel } from 'threepoint-study/simulation/performance-model';
import { simulateStudy } from 'threepoint-study/simulation/simulate-study';
import { button } from 'threepoint-ui/element';
import * as v from 'valibot';
import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { paperPlan, session } from '../model/studies';

// A laboratory adds a kind of question from outside the package: agreement, which is 1 or 0.

interface AgreementForm {
  readonly kind: 'agreement';
  readonly yes: string;
  readonly no: string;
}

interface AgreementField {
  readonly kind: 'agreement';
  readonly options: readonly (readonly [0 | 1, string])[];
  readonly answer: Answer | undefined;
  choose(value: number): void;
}

declare module 'threepoint-study/model/questionnaires/question-kind' {
  interface AnswerForms {
    agreement: AgreementForm;
  }
}

declare module 'threepoint-study/participant/questions/question-view' {
  interface ScreenFields {
    agreement: AgreementField;
  }
}

const agreement: QuestionKind<AgreementForm> = {
  kind: 'agreement',
  schema: v.strictObject({ kind: v.literal('agreement'), yes: text(40), no: text(40) }),
  answer: () => v.picklist([0, 1], 'expected 1 or 0'),
  range: () => [0, 1],
  options: () => null,
  texts: ({ yes, no }) => [
    ['yes', yes],
    ['no', no],
  ],
  columns: ({ yes, no }) => ({ answers: `1: ${yes}; 0: ${no}` }),
  simulate: (_, part) => Math.round(part),
};

const agreementView: QuestionView<AgreementForm, AgreementField> = {
  kind: 'agreement',
  field: ({ yes, no }, { given, choose }) => ({
    kind: 'agreement',
    options: [
      [1, yes],
      [0, no],
    ],
    answer: given,
    choose,
  }),
  card: ({ options, choose }) => options.map(([value, label]) => button(label, () => choose(value))),
  sheet: {
    targets: ({ options, answer, choose }) =>
      options.map(([value, label], index) => ({
        kind: 'option',
        id: `answer-${value}`,
        label,
        look: answer === value ? 'chosen' : 'plain',
        at: [60 + index * 550, 400, 530, 150],
        act: () => choose(value),
      })),
  },
};

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

/** An element without layout: tags, text and listeners, which is what a card is made of. */
class PlainElement {
  readonly children: (PlainElement | string)[] = [];
  readonly #listeners = new Map<string, () => void>();
  readonly attributes = new Map<string, string>();
  readonly tag: string;

  constructor(tag: string) {
    this.tag = tag;
  }

  setAttribute(name: string, value: string): void {
    this.attributes.set(name, value);
  }

  append(...nodes: readonly (PlainElement | string)[]): void {
    this.children.push(...nodes);
  }

  addEventListener(type: string, listener: () => void): void {
    this.#listeners.set(type, listener);
  }

  click(): void {
    this.#listeners.get('click')?.();
  }

  /** Returns the elements of a tag in the order of the document. */
  all(tag: string): readonly PlainElement[] {
    const below = this.children.flatMap((child) => (typeof child === 'string' ? [] : child.all(tag)));
    return this.tag === tag ? [this, ...below] : below;
  }
}

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
    { session: session as ShownSession, typed: null, triedToSubmit: false, refusal: null },
    { goTo: () => undefined, choose: (_, value) => choose(value), type: () => undefined },
  ).question;
}

describe('a kind of question that is registered from outside', () => {
  let remove: (() => void)[] = [];
  beforeEach(() => {
    remove = [registerQuestionKind(agreement), registerQuestionView(agreementView)];
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
    expect(questionKindNames()).toEqual(['likert', 'slider', 'choice', 'number', 'text']);
    expect(() => checkedPlan(plan())).toThrow('answer.kind: expected likert, slider, choice, number or text');
    const schema = JSON.stringify(planJsonSchema());
    expect(schema).not.toContain('agreement');
    expect(schema).toContain('"const":"text"');
  });

  test('is registered once', () => {
    expect(() => registerQuestionKind(agreement)).toThrow('"agreement" is registered already');
    expect(() => registerQuestionView(agreementView)).toThrow('"agreement" has a view already');
  });

  test('is answered on the desk card', () => {
    vi.stubGlobal('document', { createElement: (tag: string) => new PlainElement(tag) });
    const chosen: Answer[] = [];
    const [card] = questionNodes(shown(undefined, (value) => chosen.push(value))) as unknown as [PlainElement];
    const buttons = card.all('button');
    expect(buttons.map(({ children }) => children)).toEqual([['I agree'], ['I disagree']]);
    for (const one of buttons) one.click();
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
    const models = { answers: nullAnswerModel, performance: statedPerformanceModel };
    const records = simulateStudy(plan(), models, 7, 1_800_000_000).flatMap((one) => one.records);
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
