import { forceCloseDatabase, IDBFactory } from 'fake-indexeddb';
import { describe, expect, test, vi } from 'vitest';
import { beforeTheQuestions, beforeTheRound, canStart, choose, handIn, play } from './participant-steps';
import { browser } from './study-browser';
import { studyServer } from './study-server';

describe('Back', () => {
  test('among questions changes an answer, which is recorded once', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheQuestions(server);
    choose(tab, 2);
    tab.display.press('next');
    tab.display.press('back');
    handIn(tab, 4);
    await tab.exchange();
    const [answers, ...others] = server.bodies('answers');
    expect(others).toEqual([]);
    expect(Object.values(answers?.answers ?? {})).toEqual([4, 4, 4, 4, 4, 4, 4]);
  });

  test('in the browser during a round voids the attempt, and the link repeats that round', async () => {
    const server = await studyServer();
    const { device, tab } = await beforeTheRound(server);
    tab.display.press('start');
    tab.draw(1);
    await tab.visit.flow?.session.settled();
    tab.close();
    const again = await device.open();
    again.wear(true);
    await canStart(again);
    expect(again.visit.state()).toMatchObject({ step: 'archery/1/trial-1' });
    play(again, 40);
    await again.exchange();
    const played = server.bodies('trial').filter(({ condition }) => condition !== null);
    expect(played.map(({ place: { attempt }, outcome }) => [attempt, outcome.score])).toEqual([[2, 40]]);
    expect(server.events()).toEqual(['interrupted']);
  });
});

describe('storage that the browser evicts between two steps', () => {
  test('loses nothing while the page is open: later records are stored again and sent', async () => {
    const server = await studyServer();
    const opened: IDBDatabase[] = [];
    const open = IDBFactory.prototype.open;
    vi.spyOn(IDBFactory.prototype, 'open').mockImplementation(function (this: IDBFactory, ...args) {
      const request = open.apply(this, args);
      request.addEventListener('success', () => opened.push(request.result));
      return request;
    });
    const { device, tab } = await beforeTheQuestions(server);
    await tab.exchange();
    await server.stop();
    tab.display.press('pause');
    await tab.visit.flow?.session.settled();
    vi.stubGlobal('indexedDB', new IDBFactory());
    for (const database of opened) forceCloseDatabase(database as never);
    tab.display.press('resume');
    choose(tab, 4);
    await tab.visit.flow?.session.settled();
    expect(tab.visit.state()).toMatchObject({ unsent: 2, unsaved: 0 });
    tab.close();
    await server.restart();
    const again = await device.open();
    await again.exchange();
    expect(again.visit.state()).toMatchObject({ unsent: 0, step: 'archery/1/questionnaire' });
    expect(server.events()).toEqual(['pause', 'resume', 'reload']);
  });

  test('is said on the next visit, and a released place goes on with what was sent', async () => {
    const server = await studyServer();
    const { tab } = await beforeTheQuestions(server);
    handIn(tab, 4);
    await tab.exchange();
    tab.close();
    const emptied = browser(server);
    const blocked = await emptied.open();
    const why = await blocked.display.asked('consent').agree({ motion: false, language: null });
    expect(why).toContain('P01 is taken by another device');
    blocked.close();
    await server.experimenter.release('paper', 'P01');
    const again = await emptied.open();
    expect(await again.display.asked('consent').agree({ motion: false, language: null })).toBeNull();
    expect(again.visit.state()).toMatchObject({ step: tab.visit.state().step, unsent: 1 });
    await again.exchange();
    expect(again.visit.state()).toMatchObject({ unsent: 0, unsaved: 0 });
    expect(server.bodies('answers')).toHaveLength(1);
  });
});
