import fc from 'fast-check';
import { threePointNames } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import { groupsOf, ordersByGroup, ordersOf } from '../../../src/study/model/plan/allocation';
import {
  checkedPlan,
  parsePlan,
  participantsOf,
  type StudyPlan,
  type StudyTask,
} from '../../../src/study/model/plan/plan';
import { blindLabel, scheduleFor } from '../../../src/study/model/plan/schedule';
import { seed } from '../../threepoint/core/arbitraries';
import { paperFile, paperPlan, planWith } from './studies';

const orderNames = (plan: StudyPlan, task: StudyTask) =>
  ordersByGroup(plan, task).map((order) => order.map(({ id }) => id).join(' '));

function counts(names: readonly string[]): Record<string, number> {
  const found: Record<string, number> = {};
  for (const name of names) found[name] = (found[name] ?? 0) + 1;
  return found;
}

const conditionsOf = (count: number): StudyPlan['conditions'] =>
  Array.from({ length: count }, (_, index) => ({ id: `c${index}`, label: `Condition ${index}`, estimator: 'ik' }));

describe('limits at which participants are asked to stop', () => {
  const limited = (limit: object) => () => checkedPlan(paperPlan({ askToStop: [{ ...sick, ...limit }] }));
  const sick = { questionnaire: 'archery', measure: 'Q2', atLeast: 4 };

  test('are of scales and questions that the study asks', () => {
    expect(limited({})().askToStop).toEqual([sick]);
    expect(limited({ questionnaire: 'ssq' })).toThrow('askToStop[0].questionnaire: no task asks "ssq"');
    expect(limited({ measure: 'Q9' })).toThrow('askToStop[0].measure: "archery" has no scale "Q9"');
  });

  test('the questionnaire for simulator sickness has them for its total', () => {
    const [archery] = paperPlan().tasks as [StudyTask];
    const plan = paperPlan({
      tasks: [{ ...archery, questionnaire: ['ssq'] }],
      askToStop: [{ questionnaire: 'ssq', measure: 'total', atLeast: 40 }],
    });
    expect(checkedPlan(plan).askToStop).toHaveLength(1);
  });
});

describe('the shipped study', () => {
  test('is the one of the paper', () => {
    const plan = parsePlan(paperFile, 'paper.json');
    expect(plan.participants).toBe(15);
    expect(plan.conditions.map(({ estimator }) => estimator)).toEqual(['ik', 'paper']);
    const [archery, ball] = plan.tasks as [StudyTask, StudyTask];
    expect([archery.trialSeconds, archery.restSeconds, archery.questionnaireSeconds]).toEqual([70, 60, 420]);
    expect([ball.trialSeconds, ball.restSeconds, ball.questionnaireSeconds]).toEqual([90, 60, 420]);
    expect(groupsOf(plan, ball.groupSize)).toHaveLength(5);
    for (const { tutorial } of plan.tasks) expect(tutorial.estimator).toBe('hands-only');
  });

  test('takes a participant from consent through both games to the end', () => {
    expect(scheduleFor(paperPlan(), 'P01').steps.map(({ id }) => id)).toEqual([
      'consent',
      'demographics',
      'archery/1/calibration',
      'archery/1/tutorial',
      'archery/1/trial-1',
      'archery/1/rest',
      'archery/1/questionnaire',
      'archery/2/calibration',
      'archery/2/trial-1',
      'archery/2/rest',
      'archery/2/questionnaire',
      'ball/1/calibration',
      'ball/1/tutorial',
      'ball/1/rest-after-tutorial',
      'ball/1/trial-1',
      'ball/1/rest',
      'ball/1/questionnaire',
      'ball/2/calibration',
      'ball/2/trial-1',
      'ball/2/rest',
      'ball/2/questionnaire',
      'end',
    ]);
  });

  test('gives three observations per participant and game: 45 each, as the paper counts', () => {
    const plan = paperPlan();
    const steps = participantsOf(plan).flatMap((participant) => scheduleFor(plan, participant).steps);
    const played = (task: string) =>
      steps.filter((step) => (step.kind === 'trial' || step.kind === 'tutorial') && step.task === task).length;
    expect(played('archery')).toBe(45);
    expect(played('ball')).toBe(45);
  });
});

describe('the order of conditions', () => {
  test('fifteen participants get the two orders eight and seven times, five groups three and two', () => {
    const plan = paperPlan();
    const [archery, ball] = plan.tasks as [StudyTask, StudyTask];
    expect(Object.values(counts(orderNames(plan, archery))).toSorted()).toEqual([7, 8]);
    expect(Object.values(counts(orderNames(plan, ball))).toSorted()).toEqual([2, 3]);
  });

  test('comes equally often, every order, with any seed', () => {
    fc.assert(
      fc.property(
        fc.nat(2 ** 31 - 1),
        fc.constantFrom(2, 3, 4),
        fc.integer({ min: 1, max: 4 }),
        (planSeed, count, rounds) => {
          const orders = ordersOf({ orders: 'all', conditions: conditionsOf(count) });
          const plan = checkedPlan(
            paperPlan({
              seed: planSeed,
              conditions: conditionsOf(count),
              participants: orders.length * rounds,
              tasks: [{ ...(paperPlan().tasks[0] as StudyTask), groupSize: 1 }],
            }),
          );
          const found = Object.values(counts(orderNames(plan, plan.tasks[0] as StudyTask)));
          expect(found).toEqual(new Array(orders.length).fill(rounds));
        },
      ),
      { seed },
    );
  });

  test('is never ahead by more than one, after however many participants', () => {
    fc.assert(
      fc.property(fc.nat(2 ** 31 - 1), fc.integer({ min: 1, max: 40 }), (planSeed, participants) => {
        const task = { ...(paperPlan().tasks[0] as StudyTask), groupSize: 1 };
        const plan = checkedPlan(
          paperPlan({ seed: planSeed, conditions: conditionsOf(3), participants, tasks: [task] }),
        );
        const found = counts(orderNames(plan, task));
        const all = ordersOf(plan).map((order) => found[order.map(({ id }) => id).join(' ')] ?? 0);
        expect(Math.max(...all) - Math.min(...all)).toBeLessThanOrEqual(1);
      }),
      { seed },
    );
  });

  test('is drawn by the seed: the same again, and another for some other seed', () => {
    const [archery] = paperPlan().tasks as [StudyTask];
    expect(orderNames(paperPlan(), archery)).toEqual(orderNames(paperPlan(), archery));
    const drawn = new Set(
      Array.from({ length: 20 }, (_, other) => orderNames(paperPlan({ seed: other }), archery).join()),
    );
    expect(drawn.size).toBeGreaterThan(10);
  });

  test.each([2, 3, 4, 5, 6, 7, 12, 15, 20])(
    '%i conditions follow Williams: each at each place and after each other equally often',
    (count) => {
      const orders = ordersOf({ orders: 'williams', conditions: conditionsOf(count) });
      expect(orders).toHaveLength(count % 2 === 0 ? count : 2 * count);
      const places = counts(orders.flatMap((order) => order.map(({ id }, place) => `${id} at ${place}`)));
      const pairs = counts(
        orders.flatMap((order) => order.slice(1).map(({ id }, index) => `${order[index]?.id} then ${id}`)),
      );
      expect(new Set(Object.values(places)).size).toBe(1);
      expect(Object.keys(places)).toHaveLength(count * count);
      expect(new Set(Object.values(pairs)).size).toBe(1);
      expect(Object.keys(pairs)).toHaveLength(count * (count - 1));
    },
  );

  test('is shared by those who play together, and no one plays twice', () => {
    const plan = paperPlan();
    const groups = groupsOf(plan, 3);
    expect(groups.flat().toSorted()).toEqual(participantsOf(plan));
    for (const members of groups) {
      const orders = members.map((member) =>
        scheduleFor(plan, member)
          .steps.flatMap((step) => (step.kind === 'trial' && step.task === 'ball' ? [step.condition] : []))
          .join(),
      );
      expect(new Set(orders).size).toBe(1);
    }
  });

  test('is not told to the participant', () => {
    const plan = paperPlan();
    for (const step of scheduleFor(plan, 'P01').steps) {
      if (!('block' in step)) continue;
      for (const { id, label, estimator } of plan.conditions) {
        expect(blindLabel(step)).not.toContain(id);
        expect(blindLabel(step)).not.toContain(label);
        expect(blindLabel(step)).not.toContain(estimator);
        expect(step.id).not.toContain(id);
      }
    }
  });
});

test.each(threePointNames)('the condition of a study may have %s', (estimator) => {
  const plan = parsePlan(
    JSON.stringify(planWith(JSON.parse(paperFile), 'conditions.1.estimator', estimator)),
    'mine.json',
  );
  expect(plan.conditions[1]!.estimator).toBe(estimator);
});

describe('a study file with a mistake', () => {
  test.each<[string, string, unknown, string]>([
    ['a missing field', 'seed', undefined, 'seed: '],
    ['an unknown method', 'conditions.1.estimator', 'magic', 'conditions[1].estimator: expected one of'],
    ['a number in quotes', 'tasks.0.trialSeconds', '70', 'tasks[0].trialSeconds: expected a number from 1 to 3600'],
    ['half a repetition', 'tasks.1.repetitions', 1.5, 'tasks[1].repetitions: expected a whole number'],
    ['a field that is not read', 'tasks.0.restSecond', 60, 'tasks[0].restSecond: '],
    [
      'two conditions of one name',
      'conditions.1.id',
      'ik',
      'conditions[1].id: "ik" is the name of conditions[0].id too',
    ],
    ['one condition', 'conditions', conditionsOf(1), 'conditions: expected at least two'],
    ['uneven groups', 'participants', 16, 'tasks[1].groupSize: 16 participants cannot be divided into groups of 3'],
    ['an empty consent', 'consent.paragraphs', [''], 'consent.paragraphs[0]: expected text, found none'],
    ['a newer version', 'version', 2, 'version: expected 1'],
    ['another file', 'format', 'recording', 'format: expected "threepoint-study"'],
    ['too many orders', 'conditions', conditionsOf(5), 'orders: all orders of 5 conditions'],
  ])('%s: the message names file and field', (_, path, value, message) => {
    const wrong = JSON.stringify(planWith(JSON.parse(paperFile), path, value));
    expect(() => parsePlan(wrong, 'mine.json')).toThrow(`mine.json: ${message}`);
  });

  test('is refused as no JSON', () => {
    expect(() => parsePlan('{', 'mine.json')).toThrow('mine.json: this is not JSON');
  });

  test('has no schedule for a participant who is not in it', () => {
    expect(() => scheduleFor(paperPlan(), 'P16')).toThrow('P01 to P15, not P16');
  });
});

describe('the size of a group', () => {
  const groupsOfSize = (game: StudyTask['game'], groupSize: number) => () =>
    checkedPlan(paperPlan({ tasks: [{ ...(paperPlan().tasks[0] as StudyTask), game, groupSize }] }));

  test('is one in archery: one score of more would count for all', () => {
    expect(groupsOfSize('archery', 3)).toThrow('tasks[0].groupSize: archery is played alone: expected 1');
  });

  test.each([1, 5])('is three in the ball game: %i begin no round', (size) => {
    expect(groupsOfSize('ball', size)).toThrow('tasks[0].groupSize: the ball game is played by three: expected 3');
  });
});
