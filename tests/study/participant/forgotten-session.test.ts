import { expect, test } from 'vitest';
import { addCopy } from '../../../src/study/pages/experimenter/store-simulation';
import { openStudyVault } from '../../../src/study/participant/session/study-vault';
import { agree, beforeTheQuestions, choose } from './participant-steps';
import { browser } from './study-browser';
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

test('the next try of a plan begins with consent in the same browser', async () => {
  const server = await studyServer();
  const { open } = browser(server);
  const tryIt = async () => {
    const { id } = await addCopy(server.experimenter, server.plan, 'try');
    const [first] = await server.experimenter.participants(id);
    return open({ study: id, invitation: first?.invitation ?? null });
  };
  const tab = await tryIt();
  await agree(tab);
  await tab.exchange();
  tab.close();
  expect((await tryIt()).display.shown).toBe('consent');
});
