import { expect, test } from 'vitest';
import { openStudyVault } from '../../../src/study/participant/session/study-vault';
import { beforeTheQuestions, choose } from './participant-steps';
import { place, studyServer } from './study-server';

test('a press after a withdrawal in another tab stores no participant in this browser', async () => {
  const server = await studyServer();
  const { tab } = await beforeTheQuestions(server);
  await tab.exchange();
  server.store.deletion.delete('paper', 'P01', 'withdrawn', 1e9);
  const vault = await openStudyVault();
  await vault.forget(place);
  choose(tab, 4);
  tab.display.press('pause');
  await tab.exchange();
  expect(tab.display.shown).toBe('locked-out');
  expect(await vault.session(place)).toBeNull();
  expect(await vault.records(place)).toEqual([]);
  // Nothing is lost that should be kept: the page may be closed without a question.
  expect(tab.visit.losesAnswers).toBe(false);
});
