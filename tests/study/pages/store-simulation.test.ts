import { expect, test } from 'vitest';
import { createExperimenterClient } from '../../../src/study/client/study-client';
import { measuresIn, overallComparisons } from '../../../src/study/model/results/exported-results';
import { answersIn, trialsIn } from '../../../src/study/model/tables/study-tables';
import { addCopy, storeSimulation } from '../../../src/study/pages/experimenter/store-simulation';
import { examplePlan, latencyPlan } from '../model/studies';
import { experimenter, now, servedStudies } from '../server/running-studies';

const effects = { answers: { 'late-200': -1.5 }, scores: {} };

/** A real server with the study of three latencies, in which a person takes part. */
async function server() {
  const served = await servedStudies();
  const plan = latencyPlan({ participants: 6 });
  served.store.plans.add(plan, { simulated: false, at: now });
  served.store.places.claim('latency', 'P01', now);
  return { ...served, plan, client: createExperimenterClient(experimenter, served.origin) };
}

test('a simulation runs the plan to its end in a separate study, with the stated effects', async () => {
  const { client, plan } = await server();
  const reported: string[] = [];
  const onProgress = (done: number, all: number) => reported.push(`${done}/${all}`);
  expect(await storeSimulation(client, plan, { seed: 3, effects, at: now, onProgress })).toBe('latency-simulated');
  expect(reported.at(-1)).toBe('6/6');
  const { records, simulated, plan: simulatedPlan } = await client.records('latency-simulated');
  expect(simulated).toBe(true);
  expect(simulatedPlan.title).toBe(`SIMULATED: ${plan.title}`);
  expect(records.every((record) => record.simulated)).toBe(true);
  expect((await client.participants('latency-simulated')).map(({ session }) => session?.kind)).toEqual(
    Array(6).fill('end'),
  );
  expect(trialsIn(records).filter(({ excluded }) => !excluded)).toHaveLength(6 * 3);
  const compared = overallComparisons(measuresIn(records, simulatedPlan).answers, simulatedPlan);
  expect(compared.filter(({ variance }) => (variance?.within?.p ?? 1) < 0.05).length).toBeGreaterThan(4);
  expect((await client.records('latency')).records).toEqual([]);
});

test('a simulation of a study in two languages is called SIMULATED in both', async () => {
  const { client } = await server();
  const { title, ...plan } = examplePlan();
  const id = await storeSimulation(
    client,
    { ...plan, title, participants: 2 },
    { seed: 3, effects: { answers: {}, scores: {} }, at: now },
  );
  const { en, de } = title as Readonly<Record<'en' | 'de', string>>;
  expect((await client.records(id)).plan.title).toEqual({ en: `SIMULATED: ${en}`, de: `SIMULATED: ${de}` });
  expect((await client.studies()).map((listed) => listed.title)).toContain(`SIMULATED: ${en}`);
});

test('another simulation takes the place of the first, and is the same for the same seed', async () => {
  const { client, plan } = await server();
  const answersOf = async () =>
    answersIn((await client.records('latency-simulated')).records, plan).map(({ answer }) => answer);
  await storeSimulation(client, plan, { seed: 3, effects, at: now });
  const first = await answersOf();
  await storeSimulation(client, plan, { seed: 3, effects, at: now });
  expect(await answersOf()).toEqual(first);
  await storeSimulation(client, plan, { seed: 4, effects, at: now });
  expect(await answersOf()).not.toEqual(first);
});

test('a copy to try and a simulation of a study do not replace each other', async () => {
  const { client, plan } = await server();
  await storeSimulation(client, plan, { seed: 3, effects, at: now });
  expect((await addCopy(client, plan, 'try')).id).toBe('latency-try');
  expect((await client.records('latency-simulated')).records.length).toBeGreaterThan(0);
  expect((await client.studies()).map(({ id }) => id).toSorted()).toEqual([
    'latency',
    'latency-simulated',
    'latency-try',
  ]);
});

test('a simulated study goes at once and whole; one of people does not', async () => {
  const { client, plan, store } = await server();
  await storeSimulation(client, plan, { seed: 3, effects, at: now });
  await client.delete('latency-simulated', 'P02');
  await client.deleteSimulated('latency-simulated');
  expect((await client.studies()).map(({ id }) => id)).toEqual(['latency']);
  await expect(client.records('latency-simulated')).rejects.toThrow('there is no study');
  await expect(client.deleteSimulated('latency')).rejects.toThrow('has data of people');
  expect(store.overview('latency', now)[0]?.claimed).toBe(true);
});

test('an effect on what the plan does not have is named, and nothing is begun', async () => {
  const { client, plan } = await server();
  const wrong = { answers: { sideways: 1 }, scores: {} };
  await expect(storeSimulation(client, plan, { seed: 1, effects: wrong, at: now })).rejects.toThrow(
    'no condition or cohort "sideways"',
  );
  expect((await client.studies()).map(({ id }) => id)).toEqual(['latency']);
});
