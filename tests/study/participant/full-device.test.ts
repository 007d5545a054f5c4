import { afterEach, expect, test, vi } from 'vitest';
import { beforeTheQuestions } from './participant-steps';
import type { Tab } from './study-browser';
import { studyServer } from './study-server';

afterEach(() => vi.restoreAllMocks());

/** From now on nothing more fits onto the device; what this returns makes room again. */
function fillDevice(): () => void {
  const put = vi.spyOn(IDBObjectStore.prototype, 'put').mockImplementation(() => {
    throw new DOMException('the quota is used up', 'QuotaExceededError');
  });
  return () => put.mockRestore();
}

function choose(tab: Tab, value: number): void {
  const field = tab.display.screen?.question?.field;
  if (field?.kind !== 'likert') throw new Error(`expected a Likert scale on "${tab.display.shown}"`);
  field.choose(value);
}

test('answers given while the device is full are there after a crash: the server was told them', async () => {
  const { device, tab } = await beforeTheQuestions(await studyServer());
  choose(tab, 4);
  await tab.exchange();
  const makeRoom = fillDevice();
  choose(tab, 2);
  tab.display.press('next');
  choose(tab, 5);
  await tab.exchange();
  tab.close();
  makeRoom();
  const again = await device.open();
  expect(again.display.shown).toBe('question-Q3');
  again.display.press('back');
  again.display.press('back');
  expect(again.display.screen?.question?.field).toMatchObject({ answer: 2 });
});

test('what happened while the device was full keeps its place in the records after a crash', async () => {
  const server = await studyServer();
  const { device, tab } = await beforeTheQuestions(server);
  await tab.exchange();
  const makeRoom = fillDevice();
  await server.experimenter.command('paper', 'P01', { type: 'pause' });
  await tab.exchange();
  tab.display.press('resume');
  await tab.exchange();
  tab.close();
  makeRoom();
  const again = await device.open();
  await again.exchange();
  expect(again.display.shown).toBe('question-Q1');
  expect(again.visit.state().unsent).toBe(0);
  const events = server.store.records.all('paper').flatMap((one) => (one.kind === 'event' ? [one.body.type] : []));
  expect(events).toEqual(['pause', 'resume', 'reload']);
});
