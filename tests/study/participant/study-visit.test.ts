import { estimatorNames } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import { inertSeconds } from '../../../src/study/participant/inert-sheet';
import { openStudyVault } from '../../../src/study/participant/session/study-vault';
import { aWomanOf26 } from '../model/studies';
import {
  agree,
  beforeTheQuestions,
  beforeTheRound,
  canStart,
  choose,
  handIn,
  measure,
  play,
} from './participant-steps';
import { browser, ofAnother } from './study-browser';
import { place, studyServer } from './study-server';

describe('the entrance', () => {
  test('an address without a participant asks for the code, and leads to the entered place', async () => {
    const tab = await browser(await studyServer()).open({ participant: null, invitation: null });
    const form = tab.display.asked('participant');
    expect(form).toMatchObject({ problem: null, known: { participant: null, invitation: null } });
    form.go({ participant: 'P02', invitation: 'AAAA-BBBB-CCCC-DDDD' });
    expect(await tab.wentTo).toEqual({ participant: 'P02', invitation: 'AAAA-BBBB-CCCC-DDDD' });
    expect(tab.visit.state()).toMatchObject({ screen: 'participant', step: null, running: false });
  });

  test('a wrong invitation is reported after consent, and the place stays free', async () => {
    const server = await studyServer();
    const tab = await browser(server).open({ invitation: 'AAAA-BBBB-CCCC-DDDD' });
    expect(await tab.display.asked('consent').agree({ motion: false, language: null })).toBeNull();
    expect(tab.display.asked('participant').problem).toContain('not the invitation of P01');
    expect(server.store.overview('paper', 1e9)[0]?.claimed).toBe(false);
  });

  test('a text that changed during reading is shown again, and the place stays free', async () => {
    const server = await studyServer();
    const { plan, store } = server;
    const tab = await browser(server).open();
    store.places.claim('paper', 'P09', 1e9);
    const changed = { ...plan, consent: { ...plan.consent, version: 'newer', paragraphs: ['Another text.'] } };
    store.plans.add(changed, { simulated: false, at: 1e9, newVersion: true });
    expect(await tab.display.asked('consent').agree({ motion: false, language: null })).toBeNull();
    expect(await tab.wentTo).toBe('reload');
    tab.close();
    const again = await browser(server).open();
    expect(again.display.asked('consent').study.consent.paragraphs).toEqual(['Another text.']);
    expect(await again.display.asked('consent').agree({ motion: false, language: null })).toBeNull();
    expect(store.overview('paper', 1e9)[0]).toMatchObject({ participant: 'P01', claimed: true });
  });

  test.each(['participant', 'consent'] as const)(
    'a participant who leaves at the first screen, the %s form, is thanked and stored nowhere',
    async (first) => {
      const server = await studyServer();
      const tab = await browser(server).open(first === 'participant' ? { invitation: null } : {});
      const form = tab.display.asked(first);
      form.decline(form.phrases);
      expect(tab.display.shown).toBe('declined');
      const [state] = server.store.overview('paper', 1e9);
      expect(state).toMatchObject({ claimed: false, records: 0, session: null, invitation: server.invitation });
      const vault = await openStudyVault();
      expect(await vault.session(place)).toBeNull();
      expect(await vault.records(place)).toEqual([]);
    },
  );

  test('an unknown study and a server that does not answer are reported', async () => {
    const server = await studyServer();
    const elsewhere = await browser(server).open({ study: 'another' });
    expect(elsewhere.display.asked('fault').text).toBe(
      'There is no study "another" on this server. Compare the address with your link.',
    );
    await server.stop();
    const alone = await browser(server).open();
    expect(alone.display.asked('fault').text).toContain('the server does not answer');
  });

  test('a second tab with the same place leads back to the first, until that is closed', async () => {
    const device = browser(await studyServer());
    const first = await device.open();
    await agree(first);
    const second = await device.open();
    expect(second.display.asked('fault').text).toContain('P01 is open in another tab');
    await first.exchange();
    first.close();
    const third = await device.open();
    expect(third.display.shown).toBe('demographics');
  });
});

describe('the participant', () => {
  test('gets the bow in the other hand and the measured body, also after a reload', async () => {
    const { device, tab } = await beforeTheRound(await studyServer());
    const { bowSide, measures, actor } = tab.host;
    expect(bowSide).toBe('left');
    expect(measures?.eyeHeight).toBeCloseTo(1.6, 1);
    expect(actor).toBe(false);
    await tab.exchange();
    tab.close();
    const again = await device.open();
    expect(again.host).toMatchObject({ bowSide, measures });
  });

  test('has no measures before the first ones: those that the page has are another person’s', async () => {
    const tab = await browser(await studyServer()).open();
    expect(tab.host.measures).toEqual(ofAnother);
    await agree(tab);
    expect(tab.host.measures).toBeNull();
  });

  test('is not measured any further when the headset comes off meanwhile', async () => {
    const tab = await browser(await studyServer()).open();
    await agree(tab);
    tab.display.asked('demographics').done(aWomanOf26);
    tab.wear(true);
    tab.display.press('calibrate');
    tab.draw(4);
    expect(tab.display.shown).toBe('calibration-measuring');
    tab.wear(false);
    tab.draw(3);
    expect(tab.display.shown).toBe('calibration-enter');
    tab.wear(true);
    expect(tab.display.shown).toBe('calibration');
    expect(tab.host.measures).toBeNull();
  });
});

describe('a round', () => {
  test('reaches the server with score, frames and, by consent, movements', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheRound(server, true);
    play(tab, 40);
    await tab.exchange();
    const [practice, round] = server.bodies('trial');
    expect(practice?.condition).toBeNull();
    expect(round).toMatchObject({
      condition: tab.host.estimator(),
      outcome: { score: 40, maximum: 50, ended: 'arrows' },
    });
    expect(round?.outcome.frames.count).toBe(30);
    expect(server.store.motion.all('paper').map(({ trial }) => trial)).toEqual(['archery/1/trial-1@1.1:trial']);
    expect(tab.visit.state()).toMatchObject({ unsent: 0, unsaved: 0, online: true });
  });

  test.each([
    ['the headset comes off', 'playing'],
    ['its game breaks off', 'playing'],
    ['its game breaks off', 'paused'],
  ] as const)('is void and is played again when %s while it is %s', async (what, state) => {
    const server = await studyServer();
    const { tab } = await beforeTheRound(server);
    const { archery } = tab.host.games;
    tab.display.press('start');
    tab.draw(1);
    expect(tab.visit.state()).toMatchObject({ screen: 'playing', running: true });
    const paused = state === 'paused';
    if (paused) await server.experimenter.command('paper', 'P01', { type: 'pause' });
    await tab.exchange();
    if (what === 'the headset comes off') {
      tab.wear(false);
      expect(tab.visit.state().running).toBe(false);
      expect(tab.display.shown).toBe('trial-enter');
      tab.wear(true);
    } else {
      archery.breakOff();
      tab.draw(1);
    }
    expect(archery.running).toBe(false);
    if (paused) tab.display.press('resume');
    expect(tab.display.shown).toBe('trial-ready');
    expect(tab.display.inHeadset?.text[0]).toBe('The last attempt was interrupted and does not count.');
    await canStart(tab);
    play(tab, 20);
    await tab.exchange();
    expect(server.events()).toEqual(paused ? ['pause', 'interrupted', 'resume'] : ['interrupted']);
    expect(server.bodies('trial').map(({ place, outcome }) => [place.attempt, outcome.score])).toEqual([
      [1, 10],
      [2, 20],
    ]);
  });

  test('is set aside by a void, on a sheet that takes no press at first', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheQuestions(server);
    expect(tab.display.shown).toBe('question-Q1');
    const command = { type: 'void-block', reason: 'the phone rang', repeat: true } as const;
    await server.experimenter.command('paper', 'P01', command);
    await tab.exchange();
    const looks = () => tab.display.screen?.buttons.map(({ id, look }) => [id, look === 'off']);
    expect(tab.display.shown).toBe('calibration');
    expect(tab.display.screen?.text[0]).toBe('The experimenter has set the last part aside. It does not count.');
    expect(looks()).toEqual([
      ['calibrate', true],
      ['pause', true],
    ]);
    tab.pass(inertSeconds + 0.5);
    expect(looks()).toEqual([
      ['calibrate', false],
      ['pause', false],
    ]);
    // The practice was finished before.
    await measure(tab);
    expect(tab.visit.state().step).toBe('archery/1/trial-1');
    expect(tab.display.screen?.text[0]).not.toContain('set the last part aside');
  });

  test('stands in a pause, headset on or off, and goes on as the same attempt', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheRound(server);
    const { archery } = tab.host.games;
    tab.display.press('start');
    tab.draw(1);
    await server.experimenter.command('paper', 'P01', { type: 'pause' });
    await tab.exchange();
    expect(tab.display.shown).toBe('paused');
    expect(archery.paused).toBe(true);
    expect(tab.visit.flow?.paused).toBe(true);
    tab.wear(false);
    tab.display.press('resume');
    expect(tab.visit.flow?.paused).toBe(true);
    tab.wear(true);
    expect(tab.display.shown).toBe('playing');
    expect(archery).toMatchObject({ paused: false, running: true });
    archery.hit(30);
    tab.draw(3);
    await tab.exchange();
    expect(server.bodies('trial').map(({ place }) => place.attempt)).toEqual([1, 1]);
    expect(server.events()).toEqual(['pause', 'resume']);
  });

  test('is loaded again for its block’s next run when the experimenter voids the block', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheRound(server);
    const { archery } = tab.host.games;
    tab.display.press('start');
    tab.draw(1);
    await server.experimenter.command('paper', 'P01', {
      type: 'void-block',
      reason: 'a cable came loose',
      repeat: true,
    });
    await tab.exchange();
    expect(archery.running).toBe(false);
    expect(tab.display.shown).toBe('calibration');
    await measure(tab);
    play(tab, 30);
    await tab.exchange();
    const rounds = server.bodies('trial').filter(({ condition }) => condition !== null);
    expect(rounds.map(({ place, outcome }) => [place.run, outcome.score])).toEqual([[2, 30]]);
  });

  test('is started by the experimenter too, once the headset is on', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheRound(server);
    tab.wear(false);
    await server.experimenter.command('paper', 'P01', { type: 'start' });
    await tab.exchange();
    expect(tab.host.games.archery.running).toBe(false);
    tab.wear(true);
    expect(tab.host.games.archery.running).toBe(true);
    expect(tab.visit.state().running).toBe(true);
  });

  test('lies alike in both conditions, and the practice does not', async () => {
    const { tab } = await beforeTheQuestions(await studyServer());
    handIn(tab, 4);
    expect(tab.display.shown).toBe('calibration');
    await measure(tab);
    play(tab, 40);
    const [practice, first, second] = tab.host.games.archery.seeds;
    expect(second).toBe(first);
    expect(practice).not.toBe(first);
  });

  test('says why its game refuses, and can be prepared again', async () => {
    const tab = await browser(await studyServer()).open();
    await agree(tab);
    tab.display.asked('demographics').done(aWomanOf26);
    const { archery } = tab.host.games;
    archery.refusal = 'The archery range could not be opened.';
    tab.wear(true);
    tab.display.press('calibrate');
    tab.draw(6);
    await tab.display.reaches('trial-failed');
    expect(tab.display.inHeadset).toMatchObject({ text: ['The archery range could not be opened.'], trouble: true });
    // Time alone changes nothing.
    tab.pass(5);
    expect(archery.places).toHaveLength(1);
    archery.refusal = null;
    tab.display.press('again');
    await canStart(tab);
    expect(archery.places).toHaveLength(2);
  });

  test('is not played with another body than the plan’s', async () => {
    const { tab } = await beforeTheQuestions(await studyServer());
    for (const estimator of estimatorNames) tab.host.missing.add(estimator);
    handIn(tab, 4);
    tab.display.press('calibrate');
    tab.draw(6);
    await tab.display.reaches('trial-failed');
    expect(tab.display.screen?.text).toEqual(['The body of this round could not be loaded.']);
  });
});

describe('a questionnaire', () => {
  test('resumes after a reload at its first missing answer, in the body of its round', async () => {
    const { device, tab } = await beforeTheQuestions(await studyServer());
    choose(tab, 3);
    tab.display.press('next');
    tab.display.press('next');
    expect(tab.display.shown).toBe('question-Q3');
    choose(tab, 5);
    await tab.exchange();
    tab.close();
    const { embodiment } = tab.host;

    const again = await device.open();
    expect(again.display.shown).toBe('question-Q2');
    // A fresh page has hands alone, as the practice had.
    expect(again.host.embodiment).toEqual(embodiment);
    expect(embodiment.estimator).not.toBe('hands-only');
    expect(again.display.screen?.question?.all.map(({ state }) => state)).toEqual([
      ...['answered', 'open', 'answered'],
      ...['open', 'open', 'open', 'open'],
    ]);
  });
});

describe('a place that was released', () => {
  test('drops the trial under way, says so in the headset, and offers to forget the session', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheRound(server);
    tab.display.press('start');
    tab.draw(1);
    await tab.exchange();
    await server.experimenter.release('paper', 'P01');
    await tab.exchange();
    expect(tab.host.games.archery.running).toBe(false);
    expect(tab.visit.state().running).toBe(false);
    expect(tab.display.inHeadset?.id).toBe('locked-out');
    const form = tab.display.asked('locked-out');
    expect(form).toMatchObject({ participant: 'P01', unsent: 0 });

    form.restart();
    expect(await tab.wentTo).toBe('reload');
    expect(await (await openStudyVault()).session(place)).toBeNull();
  });
});
