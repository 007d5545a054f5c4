import { expect, test } from 'vitest';
import { simulatedPlan } from '../../../src/study/simulation/simulate-study';
import { examplePlan } from '../model/studies';
import { now, servedStudies } from '../server/running-studies';

test('a study begins as simulated under any valid name, and is called so in each language', async () => {
  const { store } = await servedStudies();
  const title = { en: `Two ${'very '.repeat(21)}alike`, de: `Zwei ${'sehr '.repeat(21)}gleiche` };
  const plan = simulatedPlan({ ...examplePlan(), id: `two-${'a'.repeat(44)}`, title });
  store.plans.add(plan, { simulated: true, at: now });
  expect(plan.id).toBe(`two-${'a'.repeat(33)}-simulated`);
  expect(plan.title).toEqual({
    en: `SIMULATED: ${title.en}`.slice(0, 120),
    de: `SIMULATED: ${title.de}`.slice(0, 120),
  });
});
