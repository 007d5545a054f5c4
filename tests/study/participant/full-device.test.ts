import { afterEach, expect, test, vi } from 'vitest';
import { fillDevice } from './participant-device';
import { beforeTheQuestions, choose } from './participant-steps';
import { studyServer } from './study-server';

afterEach(() => vi.restoreAllMocks());

test('answers given while the device is full are restored after a crash from the server', async () => {
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

test('the records of a full device keep their place after a crash', async () => {
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
  expect(server.events()).toEqual(['pause', 'resume', 'reload']);
});
