import { expect, test } from 'vitest';
import { modelsWith, simulateStudy } from '../../../src/core/rehearsal/simulate-study';
import { holm } from '../../../src/core/statistics/holm';
import { compareAnswers } from '../../../src/core/study/compare-conditions';
import { overallComparisons } from '../../../src/core/study/exported-results';
import { checkedPlan } from '../../../src/core/study/plan';
import { plannedAnalyses, plannedFamily } from '../../../src/core/study/planned';
import { answersIn, scalesIn } from '../../../src/core/study/study-tables';
import { latencyPlan } from './studies';

const plan = latencyPlan({ participants: 6 });
const effects = { answers: { 'late-200': -1 }, scores: {} };
const records = simulateStudy(plan, modelsWith(plan, effects), 5, 1e9).flatMap((one) => one.records);

test('what a plan names is a family of its own: Holm over it alone, however much else was asked', () => {
  const pair = ['late-200', 'late-0'] as const;
  const all = [answersIn(records, plan), scalesIn(records, plan)].flatMap(
    (rows) => compareAnswers(rows, [...pair]).comparisons,
  );
  expect(all.length).toBeGreaterThan(15);
  const family = plannedFamily(all, plan);
  expect(family.map(({ of }) => of)).toEqual(['ownership', 'agency', 'raw']);
  expect(family.map(({ holmP }) => holmP)).toEqual(holm(family.map(({ test }) => test?.p ?? null)));
  const analyses = plannedAnalyses(overallComparisons(scalesIn(records, plan), plan), plan);
  expect(analyses.map(({ of }) => of)).toEqual(['ownership', 'agency', 'raw']);
  expect(analyses.map(({ holmP }) => holmP)).toEqual(
    holm(analyses.map(({ variance }) => variance?.within?.correctedP ?? null)),
  );
});

test('without planned measures nothing is planned', () => {
  const { planned: _, ...unplanned } = plan;
  expect(plannedAnalyses(overallComparisons(scalesIn(records, plan), plan), unplanned)).toEqual([]);
});

test('a measure that is nowhere is named', () => {
  const wrong = { ...plan, planned: ['archery/score', 'archery/embodiment/soul'] };
  expect(() => checkedPlan(wrong)).toThrow('planned[1]: "archery/embodiment/soul" is measured nowhere');
});
