import { describe, expect, test } from 'vitest';
import { agree, beforeTheQuestions, beforeTheRound, handIn, play } from './participant-steps';
import { browser, type Tab } from './study-browser';
import { type StudyServer, studyServer } from './study-server';

const stops = (server: StudyServer) => server.bodies('event').filter(({ type }) => type === 'stop');

const stateOf = ({ store }: StudyServer) => store.overview('paper', 1e9)[0]?.session;

/**
 * That it is over for good: said on the screen and on the experimenter's page, recorded, and the same after a reload.
 */
async function expectStopped(server: StudyServer, { device, tab }: { device: ReturnType<typeof browser>; tab: Tab }) {
  expect(tab.display.shown).toBe('end');
  expect(tab.display.screen?.text.join(' ')).toContain('Your part is over');
  expect(tab.host.games.archery.running).toBe(false);
  await tab.exchange();
  expect(stateOf(server)).toMatchObject({ kind: 'end', stopped: true });
  expect(stops(server)).toHaveLength(1);
  tab.close();
  const again = await device.open();
  expect(again.display.shown).toBe('end');
  expect(again.display.screen?.text.join(' ')).toContain('Your part is over');
}

describe('a participant stops', () => {
  test('from the headset in the middle of a round: hands above the head, then two buttons', async () => {
    const server = await studyServer();
    const visit = await beforeTheRound(server);
    const { tab } = visit;
    tab.display.press('start');
    tab.draw(1);
    expect(tab.display.shown).toBe('playing');
    tab.draw(2, true);
    expect(tab.display.inHeadset?.id).toBe('paused');
    expect(tab.host.games.archery.paused).toBe(true);
    tab.display.press('ask-to-stop');
    expect(tab.display.inHeadset?.id).toBe('stopping');
    tab.display.press('stop');
    await expectStopped(server, visit);
    expect(stops(server)).toMatchObject([{ by: 'participant', step: 'archery/1/trial-1' }]);
    expect(server.store.records.all('paper').filter(({ kind }) => kind === 'trial')).toHaveLength(1);
  });

  test('hands up for a moment, or not lowered since a pause, pause nothing', async () => {
    const { tab } = await beforeTheRound(await studyServer());
    tab.display.press('start');
    tab.draw(1, true);
    tab.draw(1);
    tab.draw(1, true);
    expect(tab.display.shown).toBe('playing');
    tab.draw(1, true);
    expect(tab.display.shown).toBe('paused');
    tab.display.press('resume');
    tab.draw(3, true);
    expect(tab.display.shown).toBe('playing');
    tab.draw(1);
    tab.draw(2, true);
    expect(tab.display.shown).toBe('paused');
  });

  test('at the desk, in the questions', async () => {
    const server = await studyServer();
    const visit = await beforeTheQuestions(server);
    visit.tab.wear(false);
    for (const button of ['pause', 'ask-to-stop', 'stop']) visit.tab.display.press(button);
    await expectStopped(server, visit);
    expect(stops(server)).toMatchObject([{ by: 'participant', step: 'archery/1/questionnaire' }]);
  });

  test.each(['code', 'demographics'] as const)('at the desk, at the form %s', async (form) => {
    const server = await studyServer();
    const device = browser(server);
    const tab = await device.open();
    expect(await tab.display.asked('consent').agree({ motion: false, language: null })).toBeNull();
    if (form === 'demographics') tab.display.asked('code').noted();
    tab.display.asked(form).stop();
    await expectStopped(server, { device, tab });
    expect(tab.display.screen?.text.join(' ')).toContain('/withdraw?study=paper');
  });

  test('can decide to go on, where the visit paused', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheQuestions(server);
    tab.display.press('pause');
    tab.display.press('ask-to-stop');
    tab.display.press('go-on');
    expect(tab.display.shown).toBe('paused');
    tab.display.press('resume');
    expect(tab.display.shown).toBe('question-Q1');
    await tab.exchange();
    expect(stops(server)).toEqual([]);
  });
});

describe('the experimenter stops a participant', () => {
  const stop = { type: 'stop', by: 'experimenter', reason: 'looked pale' } as const;

  test.each(['round', 'rest', 'questions', 'pause'])('in the %s', async (where) => {
    const server = await studyServer();
    const visit = where === 'questions' ? await beforeTheQuestions(server) : await beforeTheRound(server);
    const { tab } = visit;
    if (where === 'round') tab.display.press('start');
    if (where === 'rest') play(tab, 40);
    if (where === 'pause') tab.display.press('pause');
    const { step } = tab.visit.state();
    server.store.commands.add('paper', 'P01', stop, 1e9);
    await tab.exchange();
    await expectStopped(server, visit);
    expect(stops(server)).toMatchObject([{ by: 'experimenter', reason: 'looked pale', step }]);
  });

  test('before they were asked about themselves, at the desk', async () => {
    const server = await studyServer();
    const device = browser(server);
    const tab = await device.open();
    await agree(tab);
    server.store.commands.add('paper', 'P01', stop, 1e9);
    await tab.exchange();
    await expectStopped(server, { device, tab });
  });
});

describe('a round whose end is still being looked at counts as played', () => {
  const playedIn = (server: StudyServer) => server.bodies('trial').map(({ outcome }) => outcome.score);

  /** The shot has hit, which ended the round, and the sheet has not come yet. */
  async function justOver(server: StudyServer) {
    const visit = await beforeTheRound(server);
    const { tab } = visit;
    tab.display.press('start');
    tab.draw(1);
    tab.host.games.archery.hit(40);
    tab.draw(0.5);
    expect(tab.display.shown).toBe('playing');
    return visit;
  }

  test('when the headset comes off', async () => {
    const server = await studyServer();
    const { tab } = await justOver(server);
    tab.wear(false);
    expect(tab.display.shown).toBe('rest');
    await tab.exchange();
    expect(playedIn(server)).toEqual([10, 40]);
  });

  test('when the participant pauses, who may then load the page again', async () => {
    const server = await studyServer();
    const { device, tab } = await justOver(server);
    tab.draw(1.7, true);
    expect(tab.display.shown).toBe('paused');
    await tab.exchange();
    tab.close();
    const again = await device.open();
    expect(again.visit.state().step).toBe('archery/1/rest');
    expect(playedIn(server)).toEqual([10, 40]);
  });

  test('when the experimenter stops the participant', async () => {
    const server = await studyServer();
    const visit = await justOver(server);
    server.store.commands.add('paper', 'P01', { type: 'stop', by: 'experimenter', reason: 'fire alarm' }, 1e9);
    await visit.tab.exchange();
    await expectStopped(server, visit);
    expect(playedIn(server)).toEqual([10, 40]);
  });
});

describe('answers over a value of the plan', () => {
  const unwellFrom = (atLeast: number) => ({ askToStop: [{ questionnaire: 'archery', measure: 'Q2', atLeast }] });

  test('ask to stop, and that a participant was asked and went on is recorded', async () => {
    const server = await studyServer(unwellFrom(4));
    const { tab } = await beforeTheQuestions(server);
    handIn(tab, 4);
    expect(tab.display.inHeadset?.id).toBe('unwell');
    expect(tab.display.screen?.title).toBe('How are you?');
    await tab.exchange();
    expect(stateOf(server)?.unwell).toBe(true);
    tab.display.press('go-on');
    expect(tab.display.shown).toBe('calibration');
    await tab.exchange();
    expect(server.bodies('event')).toMatchObject([
      { type: 'unwell', questionnaire: 'archery', measure: 'Q2', value: 4 },
      { type: 'go-on' },
    ]);
    expect(stateOf(server)?.unwell).toBe(false);
  });

  test('ask to stop, and the answer holds after a reload in between', async () => {
    const server = await studyServer(unwellFrom(4));
    const visit = await beforeTheQuestions(server);
    handIn(visit.tab, 5);
    await visit.tab.exchange();
    visit.tab.close();
    const tab = await visit.device.open();
    expect(tab.display.shown).toBe('unwell');
    tab.display.press('stop');
    await expectStopped(server, { ...visit, tab });
  });

  test('below it ask nothing', async () => {
    const server = await studyServer(unwellFrom(4));
    const { tab } = await beforeTheQuestions(server);
    handIn(tab, 3);
    expect(tab.display.shown).toBe('calibration');
  });
});
