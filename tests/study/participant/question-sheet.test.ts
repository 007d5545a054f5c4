import { describe, expect, test } from 'vitest';
import { phrasesOf } from '../../../src/study/model/phrases/phrases';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { begin } from '../../../src/study/model/progress/progress';
import type { Answer } from '../../../src/study/model/questionnaires/question-kind';
import type { Question } from '../../../src/study/model/questionnaires/questionnaire-schema';
import {
  type Answers,
  shippedQuestionnaires,
  typedAnswer,
} from '../../../src/study/model/questionnaires/questionnaires';
import { questionTargets } from '../../../src/study/participant/questions/question-sheet';
import { height, width } from '../../../src/study/participant/questions/sheet-target';
import { questionPart } from '../../../src/study/participant/screens/question-screen';
import type { ParticipantSession } from '../../../src/study/participant/session/participant-session';
import { expectApart } from '../../page/shell/menu-parts';
import { examplePlan } from '../model/studies';

const plan = examplePlan();
const schedule = scheduleFor(plan, 'P01');
const body = schedule.steps.flatMap((step) => (step.kind === 'questionnaire' ? [step.questionnaire] : []))[0];
const questions = body?.questions ?? [];

/** A participant who presses the targets of these questions on the sheet. */
function reader(asked: readonly Question[], language = 'en') {
  let draft: Record<string, Answer> = {};
  let typed: string | null = null;
  let at = 0;
  const choose = (id: string, value: Answer) => {
    draft = { ...draft, [id]: value };
  };
  const part = () => {
    const progress = { ...begin(schedule), draft: draft as Answers, language };
    const session = { plan, progress, phrases: phrasesOf(plan, language) } as unknown as ParticipantSession;
    return questionPart(
      asked,
      at,
      { session, questionnaire: { question: at, typed, triedToSubmit: false }, rejection: null },
      {
        choose,
        goTo: () => undefined,
        type(question, text) {
          typed = text;
          const value = typedAnswer(question.answer, text);
          const { [question.id]: _, ...others } = draft;
          draft = value === null ? others : { ...others, [question.id]: value };
        },
      },
    );
  };
  return {
    goTo(id: string) {
      at = asked.findIndex((question) => question.id === id);
      typed = null;
      return this;
    },
    press(...ids: readonly string[]) {
      for (const id of ids) {
        const target = questionTargets(part().question).find((one) => one.id === id);
        if (!target) throw new Error(`there is no "${id}" on the sheet`);
        if (target.look !== 'off') target.act();
      }
      return this;
    },
    part,
    answerTo: (id: string) => draft[id],
  };
}

describe('a question on the sheet in the headset', () => {
  test('every kind is answered by pressing: points, a place on the line, an option, keys', () => {
    const one = reader(questions);
    one.goTo('mine').press('answer-6');
    one.goTo('delay').press('answer-37');
    one.goTo('watched').press('answer-arms');
    one.goTo('guess').press('key-4', 'key-delete', 'key-3');
    one.goTo('remarks').press('key-b', 'key-o', 'key-w', 'key-space', 'key-o', 'key-k');
    expect(questions.map(({ id }) => one.answerTo(id))).toEqual([6, undefined, 37, 'arms', 3, 'bow ok']);
  });

  test('says how many still need an answer, and of the last one that it needs it', () => {
    const one = reader(questions.filter(({ id }) => id === 'mine' || id === 'delay'));
    expect(one.part().hint).toBe('* 2 of 2 still need an answer.');
    expect(one.goTo('mine').press('answer-6').part().hint).toBe('* 1 of 2 still needs an answer.');
    expect(one.goTo('delay').press('answer-37').part().hint).toBeNull();
  });

  test('a place on the line is corrected by single steps, once there is one', () => {
    const one = reader(questions).goTo('delay');
    expect(one.press('more').answerTo('delay')).toBeUndefined();
    expect(one.press('answer-100', 'more', 'less', 'less').answerTo('delay')).toBe(98);
  });

  test('a number outside its range is not an answer, and a hint states the range', () => {
    const one = reader(questions).goTo('guess').press('key-9');
    expect(one.answerTo('guess')).toBeUndefined();
    expect(one.part().hint).toBe('* Expected a whole number from 0 to 4.');
  });

  test('is read in the language of the participant', () => {
    expect(reader(questions, 'de').goTo('watched').part().question).toMatchObject({
      text: 'Worauf haben Sie am meisten geachtet?',
      field: { points: [{ label: 'Meine Hände' }, {}, {}, {}] },
    });
  });

  test('has all it is pressed on within the sheet, large enough and none upon another', () => {
    const all = [...questions, ...Object.values(shippedQuestionnaires).flatMap((shipped) => shipped.questions)];
    for (const question of all) {
      const targets = questionTargets(reader([question]).part().question);
      for (const { id, at, kind } of targets) {
        const [x, y, wide, high] = at;
        expect(
          x >= 0 && y >= 0 && x + wide <= width + 1e-6 && y + high <= Math.min(height, 646),
          `${question.id} ${id}`,
        ).toBe(true);
        if (kind !== 'tick') expect(Math.min(wide, high), `${question.id} ${id}`).toBeGreaterThan(40);
      }
      expectApart(targets);
    }
  });
});
