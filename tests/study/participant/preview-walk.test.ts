import { describe, expect, test } from 'vitest';
import { outlineOf } from '../../../src/study/model/plan/plan-outline';
import { PreviewWalk } from '../../../src/study/participant/preview/preview-walk';
import { examplePlan, latencyPlan, paperPlan } from '../model/studies';

const walkOf = (plan = examplePlan(), participant = 'P01') =>
  new PreviewWalk({
    plan,
    participant,
    withdrawalPage: 'https://lab.example.org/withdraw?study=x',
    onChange: () => undefined,
  });

function screenAt(walk: PreviewWalk) {
  const shown = walk.shown();
  if (shown.kind !== 'screen') throw new Error(`${walk.stop.id} shows no screen`);
  return shown.screen;
}
const press = (walk: PreviewWalk, id: string) =>
  screenAt(walk)
    .buttons.find((button) => button.id === id)
    ?.act();

test.each([examplePlan(), latencyPlan(), paperPlan()])(
  'every question and every step of "$id" is a stop, and each shows something',
  (plan) => {
    const walk = walkOf(plan);
    const questions = walk.stops.filter(({ kind }) => kind === 'question');
    // The outline has a line for each questionnaire as a whole, too.
    const outlined = outlineOf(plan, 'P01').filter(({ at, shows }) => at === 'either' && / of \d+, /.test(shows));
    expect(questions).toHaveLength(outlined.length);
    expect(new Set(walk.stops.map(({ id }) => id)).size).toBe(walk.stops.length);
    for (const [index, stop] of walk.stops.entries()) {
      expect(walk.index).toBe(index);
      const shown = walk.shown();
      expect(shown.kind === 'playing').toBe(stop.kind === 'playing');
      if (shown.kind === 'screen' && stop.kind === 'question') {
        expect(shown.screen.id).toBe(`question-${stop.id.split('/').at(-1)}`);
      }
      walk.next();
    }
    expect(walk.stop.kind).toBe('end');
  },
);

test('answers stay through walks back and forth, and handing in leads to missing ones', () => {
  const walk = walkOf();
  walk.goTo(walk.stops.findIndex(({ id }) => id.endsWith('/mine')));
  const { field } = screenAt(walk).question ?? {};
  if (field?.kind !== 'likert') throw new Error('expected a scale');
  field.choose(6);
  walk.goTo(walk.stops.length - 1);
  walk.goTo(walk.stops.findIndex(({ id }) => id.endsWith('/remarks')));
  expect(screenAt(walk).question?.all[0]?.state).toBe('answered');
  press(walk, 'submit');
  expect(walk.stop.id).toMatch(/strange$/);
  expect(screenAt(walk).hint).toContain('still needs an answer');
});

test('a pause can be seen and left; a language holds for all that follows', () => {
  const walk = walkOf();
  walk.setLanguage('de');
  walk.goTo(walk.stops.findIndex(({ id }) => id.endsWith('/mine')));
  expect(screenAt(walk).title).toEqual(expect.anything());
  expect(screenAt(walk).question?.text).toContain('Der virtuelle Körper');
  expect(screenAt(walk).kicker).toBe('Bogenschießen · Runde 1');
  press(walk, 'pause');
  expect(screenAt(walk).id).toBe('paused');
  press(walk, 'resume');
  expect(screenAt(walk).id).toBe('question-mine');
  walk.goTo(walk.stops.length - 1);
  expect(screenAt(walk).kicker).toBe('Zwei Avatare beim Bogenschießen, mit Fragen jeder Art');
});

describe('a screen that asks whether to stop', () => {
  const unwellPlan = () => {
    const plan = paperPlan({ askToStop: [{ questionnaire: 'archery', measure: 'Q2', atLeast: 4 }] });
    return {
      ...plan,
      tasks: plan.tasks.map((task) => (task.id === 'archery' ? { ...task, questionnaire: ['archery', 'ball'] } : task)),
    };
  };
  const atTheQuestions = () => {
    const walk = walkOf(unwellPlan());
    walk.goTo(walk.stops.findIndex(({ kind }) => kind === 'question'));
    return walk;
  };

  test('is left behind by walking on, as by its own buttons', () => {
    const walk = atTheQuestions();
    press(walk, 'pause');
    press(walk, 'ask-to-stop');
    expect(screenAt(walk).id).toBe('stopping');
    walk.next();
    expect(screenAt(walk).id).toBe('question-Q2');
  });

  test('comes after answers that reach a value of the plan, until one walks on', () => {
    const walk = atTheQuestions();
    for (let index = 1; index <= 7; index++) {
      const { field } = screenAt(walk).question ?? {};
      if (field?.kind !== 'likert') throw new Error('expected a scale');
      field.choose(5);
      press(walk, index < 7 ? 'next' : 'submit');
    }
    expect(walk.stop.id).toBe('archery/1/questionnaire-2/Q8');
    expect(screenAt(walk).id).toBe('unwell');
    walk.next();
    expect(screenAt(walk).id).toBe('question-Q9');
  });

  test('stops nothing but this look: the end is reached as usual afterwards', () => {
    const walk = atTheQuestions();
    press(walk, 'pause');
    press(walk, 'ask-to-stop');
    press(walk, 'stop');
    expect(walk.stop.kind).toBe('end');
    const stopped = screenAt(walk).text;
    walk.back();
    expect(screenAt(walk).id).toBe('question-Q12');
    walk.next();
    expect(screenAt(walk).id).toBe('end');
    expect(screenAt(walk).text).not.toEqual(stopped);
  });
});

test('a stop of one place is shown there, the others at the chosen place', () => {
  const walk = walkOf(paperPlan());
  expect(walk.place).toBe('desk');
  walk.goTo(walk.stops.findIndex(({ kind }) => kind === 'waiting'));
  expect(walk.place).toBe('headset');
  expect(screenAt(walk).text[0]).toMatch(/as soon as P\d\d and P\d\d are ready/);
  walk.showAt('desk');
  expect(walk.place).toBe('headset');
  walk.goTo(walk.stops.findIndex(({ kind }) => kind === 'question'));
  expect(walk.place).toBe('desk');
});
