import { describe, expect, test } from 'vitest';
import { aWomanOf26 } from '../model/studies';
import { agree, canStart, measure, play } from './participant-steps';
import { browser } from './study-browser';
import { type StudyServer, studyServer } from './study-server';

/** P01, who draws with the left hand, is measured on a first device, whose place is released then. */
async function measuredAndReleased(server: StudyServer, motion = false) {
  const tab = await browser(server).open();
  await agree(tab, motion);
  tab.display.asked('demographics').done({ ...aWomanOf26, handedness: 'left' });
  await measure(tab);
  await tab.exchange();
  await server.experimenter.release('paper', 'P01');
  tab.close();
  return tab.host;
}

/** The link on a second device, where consent is asked for once more. */
async function goOn(server: StudyServer, choices: { readonly motion: boolean; readonly language: string | null }) {
  const tab = await browser(server).open();
  expect(await tab.display.asked('consent').agree(choices)).toBeNull();
  tab.wear(true);
  await canStart(tab);
  expect(tab.visit.state().step).toBe('archery/1/tutorial');
  return tab;
}

const silently = { motion: false, language: null };

async function roundsRecorded(server: StudyServer, choices: typeof silently) {
  const tab = await goOn(server, choices);
  play(tab, 10);
  await canStart(tab);
  play(tab, 40);
  await tab.exchange();
  expect(tab.visit.state()).toMatchObject({ step: 'archery/1/rest', unsent: 0 });
  return server.store.motion.all('paper').map(({ trial }) => trial);
}

const remarks = (server: StudyServer) =>
  server.bodies('event').flatMap((event) => (event.type === 'remark' ? [event.text] : []));

describe('a participant who goes on with another device', () => {
  test('has the bow in the same hand there, and the body that was measured', async () => {
    const server = await studyServer();
    const first = await measuredAndReleased(server);
    expect(first.bowSide).toBe('right');
    const { host } = await goOn(server, silently);
    expect(host.bowSide).toBe('right');
    // How another headset sits, and how its controllers are held, has not been measured.
    const { eyeHeight, armSpan } = first.measures ?? {};
    expect(host.measures).toEqual({ eyeHeight, armSpan });
  });

  test('has motion kept there where that is agreed to again', async () => {
    const server = await studyServer();
    await measuredAndReleased(server, true);
    expect(await roundsRecorded(server, { ...silently, motion: true })).toEqual(['archery/1/trial-1@1.1:trial']);
    expect(remarks(server)).toEqual([]);
  });

  test('has none kept any more where it is not, and the experimenter can read why', async () => {
    const server = await studyServer();
    await measuredAndReleased(server, true);
    expect(await roundsRecorded(server, silently)).toEqual([]);
    expect(remarks(server)).toEqual([expect.stringContaining('did not agree to have motion kept')]);
  });

  test('has none kept where the consent that is recorded says no', async () => {
    const server = await studyServer();
    await measuredAndReleased(server, false);
    expect(await roundsRecorded(server, { ...silently, motion: true })).toEqual([]);
  });

  test('reads in the language chosen there', async () => {
    const server = await studyServer({ languages: ['en', 'de'] });
    const tab = await browser(server).open();
    expect(await tab.display.asked('consent').agree({ motion: false, language: 'en' })).toBeNull();
    tab.display.asked('code').noted();
    await tab.exchange();
    await server.experimenter.release('paper', 'P01');
    tab.close();
    const second = await browser(server).open();
    expect(await second.display.asked('consent').agree({ motion: false, language: 'de' })).toBeNull();
    expect(second.display.asked('demographics').phrases.language).toBe('de');
  });
});
