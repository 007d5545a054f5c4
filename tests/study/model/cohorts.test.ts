import fc from 'fast-check';
import { describe, expect, test } from 'vitest';
import { cohortsByParticipant, groupsOf, ordersByGroup } from '../../../src/study/model/plan/allocation';
import { checkedPlan, participantsOf, type StudyCohort, type StudyTask } from '../../../src/study/model/plan/plan';
import { cohortCounts, orderCounts, remarksOn } from '../../../src/study/model/plan/plan-remarks';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { seed } from '../../threepoint/core/arbitraries';
import { paperPlan } from './studies';

const bodies = (count: number): StudyCohort[] =>
  Array.from({ length: count }, (_, index) => ({
    id: `body-${index}`,
    label: `Body ${index}`,
    avatar: index % 2 === 0 ? 'woman' : 'man',
  }));

const [archery] = paperPlan().tasks as [StudyTask];

describe('cohorts', () => {
  test('appear in the schedules of their members, and in none where the plan has none', () => {
    const plan = checkedPlan(paperPlan({ cohorts: bodies(2), participants: 6, tasks: [archery] }));
    const drawn = cohortsByParticipant(plan);
    expect(participantsOf(plan).map((one) => scheduleFor(plan, one).cohort)).toEqual(
      participantsOf(plan).map((one) => drawn.get(one)?.id),
    );
    expect(scheduleFor(paperPlan(), 'P01').cohort).toBeNull();
  });

  test('are equally large, keep groups together, and contain every order', () => {
    fc.assert(
      fc.property(
        fc.nat(2 ** 31 - 1),
        fc.constantFrom(2, 3),
        fc.constantFrom(1, 3),
        fc.integer({ min: 1, max: 3 }),
        (planSeed, cohorts, groupSize, times) => {
          const task = { ...archery, groupSize, game: groupSize > 1 ? ('ball' as const) : archery.game };
          const participants = cohorts * groupSize * 2 * times;
          const plan = checkedPlan(
            paperPlan({ seed: planSeed, cohorts: bodies(cohorts), participants, tasks: [task] }),
          );
          const drawn = cohortsByParticipant(plan);
          expect([...drawn.keys()].toSorted()).toEqual(participantsOf(plan));
          expect([...cohortCounts(plan).values()]).toEqual(new Array(cohorts).fill(participants / cohorts));
          for (const members of groupsOf(plan, groupSize)) {
            expect(new Set(members.map((member) => drawn.get(member))).size).toBe(1);
          }
          for (const cohort of plan.cohorts ?? []) {
            expect([...orderCounts(plan, task, cohort).values()]).toEqual([times, times]);
          }
          expect(remarksOn(plan).filter((remark) => remark.includes('even'))).toEqual([]);
        },
      ),
      { seed },
    );
  });

  test('leave the orders of plans without them as studies have begun with them', () => {
    const names = ordersByGroup(paperPlan(), archery).map((order) => order.map(({ id }) => id).join(' '));
    expect(names.slice(0, 4)).toEqual(['ik paper', 'paper ik', 'ik paper', 'paper ik']);
  });

  test('give each participant their body under every condition, with one condition too, and in practice', () => {
    const late = { id: 'late', label: 'Late', estimator: 'ik', latencyMs: 80 } as const;
    const plan = checkedPlan(paperPlan({ cohorts: bodies(2), conditions: [late], participants: 4, tasks: [archery] }));
    for (const participant of participantsOf(plan)) {
      const { avatar } = cohortsByParticipant(plan).get(participant) as StudyCohort;
      const played = scheduleFor(plan, participant).steps.flatMap((step) => ('embodiment' in step ? [step] : []));
      expect(played.map(({ kind, embodiment }) => [kind, embodiment])).toEqual([
        ['tutorial', { avatar, estimator: 'hands-only' }],
        ['trial', { avatar, estimator: 'ik', latencyMs: 80 }],
      ]);
    }
  });
});

describe('the remarks before the first participant', () => {
  test('name orders that are not balanced, and how many participants would balance them', () => {
    expect(remarksOn(paperPlan())).toEqual([
      'Archery: the 2 orders are not balanced: some occur 8 times, others 7 times; a multiple of 6 participants would balance them.',
      'Ball game: the 2 orders are not balanced: some occur 3 times, others 2 times; a multiple of 6 participants would balance them.',
    ]);
    expect(remarksOn(paperPlan({ participants: 18 }))).toEqual([]);
  });

  test('name unbalanced cohorts, conditions with the same body, and tasks without a mirror', () => {
    const conditions = ['a', 'b'].map((id) => ({ id, label: id, estimator: 'ik' as const, mirror: true }));
    const remarks = remarksOn(checkedPlan(paperPlan({ participants: 9, cohorts: bodies(2), conditions })));
    expect(remarks).toContainEqual(expect.stringMatching(/^The cohorts are not balanced: body-0 \d, body-1 \d/));
    expect(remarks).toContain('Conditions "a" and "b" have the same body: ik, with a mirror.');
    expect(remarks).toContain('Ball game: the ball game has no mirror.');
  });
});

describe('a plan whose bodies are not clear names field and reason', () => {
  const [ik, network] = paperPlan().conditions as [StudyCohort, StudyCohort];
  test.each<[string, Parameters<typeof paperPlan>[0], string]>([
    [
      'a latency that no one could play with',
      { conditions: [{ ...ik, latencyMs: 201 }, network] },
      'conditions[0].latencyMs: expected a number from 0 to 200',
    ],
    [
      'no method',
      { conditions: [ik, network].map(({ estimator: _, ...other }) => other) },
      'conditions[0].estimator: is missing',
    ],
    [
      'an avatar in one condition alone, which would follow from the headset in the other',
      { conditions: [ik, { ...network, avatar: 'man' }] },
      'conditions[0].avatar: is missing, and conditions[1] has it',
    ],
    [
      'the same said by conditions and cohorts',
      { cohorts: bodies(2), conditions: [ik, network].map((one) => ({ ...one, avatar: 'man' as const })) },
      'conditions[0].avatar: is set by cohorts already',
    ],
    ['more cohorts than groups', { cohorts: bodies(6) }, 'cohorts: 5 groups of 3 do not fill 6 cohorts'],
    ['one condition and no cohorts', { conditions: [ik] }, 'conditions: expected at least two conditions to compare'],
  ])('%s', (_, changes, message) => {
    expect(() => checkedPlan(paperPlan(changes))).toThrow(message);
  });
});
