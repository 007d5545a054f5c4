import { IDBFactory } from 'fake-indexeddb';
import { openDB } from 'idb';
import { expect, onTestFinished, test, vi } from 'vitest';
import { openStudyVault } from '../../../src/study/participant/session/study-vault';
import { reportFigures } from '../../reliability/report-figures';
import { aWomanOf26 } from '../model/studies';
import { agree, beforeTheQuestions, choose } from './participant-steps';
import { browser, type Tab } from './study-browser';
import { place, type StudyServer, studyServer } from './study-server';

/** How long these pages wait for their storage [ms]: far longer than a request takes, far shorter than in a browser. */
const limitMs = 250;

const blockedFactories = {
  'is null': null,
  'is missing': undefined,
  'throws when it is opened': {
    open() {
      throw new DOMException('storage is not allowed', 'SecurityError');
    },
  },
  'is of a newer version': {
    open(name: string, version: number) {
      const factory = new IDBFactory();
      factory.open(name, version + 1);
      return factory.open(name, version);
    },
  },
  'never answers': { open: () => new IDBOpenDBRequest() },
};

/** The experimenter's commands arrive, and what is pressed is recorded. */
async function staysInTouch(server: StudyServer, tab: Tab): Promise<void> {
  await server.experimenter.command('paper', 'P01', { type: 'pause' });
  await tab.exchange();
  expect(tab.display.shown).toBe('paused');
  tab.display.press('resume');
  await tab.exchange();
  expect(tab.visit.state()).toMatchObject({ unsent: 0, unsaved: 0, online: true });
  expect(tab.visit.losesAnswers).toBe(false);
}

test.each(Object.entries(blockedFactories))(
  'a participant takes part where IndexedDB %s',
  {
    tags: ['full'],
  },
  async (how, factory) => {
    const server = await studyServer();
    const device = browser(server, limitMs);
    vi.stubGlobal('indexedDB', factory);
    const tab = await device.open();
    await agree(tab);
    expect(tab.display.asked('demographics').done(aWomanOf26)).toBeNull();
    expect(tab.display.screen?.footnote).toContain('this browser offers no storage');
    await staysInTouch(server, tab);
    const kinds = server.store.records.all('paper').map(({ kind }) => kind);
    expect(kinds.filter((kind) => kind !== 'event')).toEqual(['consent', 'demographics']);
    reportFigures('storage-blocked', { [`IndexedDB ${how}`]: 'takes part' });
  },
);

/** Keeps the stores busy, like another page that writes without end; returns a function that releases them. */
async function occupyStorage(): Promise<() => void> {
  const database = await openDB('threepoint-studies');
  const { objectStoreNames } = database;
  const store = database.transaction([...objectStoreNames], 'readwrite').objectStore('sessions');
  let occupied = true;
  const goOn = async (): Promise<void> => {
    while (occupied) await store.count();
  };
  void goOn();
  const letGo = () => {
    occupied = false;
  };
  onTestFinished(letGo);
  return letGo;
}

const failures = {
  'is closed by the browser': async () => {
    vi.spyOn(IDBDatabase.prototype, 'transaction').mockImplementation(() => {
      throw new DOMException('the connection is closing', 'InvalidStateError');
    });
  },
  'stops answering': occupyStorage,
};

test.each(Object.entries(failures))(
  'a session goes on where IndexedDB %s under way, and its answers reach the server',
  { tags: ['full'] },
  async (how, fail) => {
    const server = await studyServer();
    const { tab } = await beforeTheQuestions(server, limitMs);
    await tab.exchange();
    await fail();
    choose(tab, 4);
    await staysInTouch(server, tab);
    reportFigures('storage-blocked', { [`IndexedDB ${how} under way`]: 'goes on' });
  },
);

test('storage that answers again takes what it missed', { tags: ['full'] }, async () => {
  const { tab } = await beforeTheQuestions(await studyServer(), limitMs);
  await tab.exchange();
  const letGo = await occupyStorage();
  tab.display.press('pause');
  await tab.exchange();
  letGo();
  tab.display.press('resume');
  await tab.exchange();
  const vault = await openStudyVault();
  await expect.poll(async () => (await vault.session(place))?.progress.paused).toBe(false);
});

test('a session that the storage withholds is not begun twice and resumes once it is readable', {
  tags: ['full'],
}, async () => {
  const server = await studyServer();
  const { device, tab } = await beforeTheQuestions(server, limitMs);
  await tab.exchange();
  tab.close();
  const letGo = await occupyStorage();
  const blocked = await device.open();
  const why = await blocked.display.asked('consent').agree({ motion: false, language: null });
  expect(why).toContain('P01 is taken by another device');
  blocked.close();
  letGo();
  const again = await device.open();
  expect(again.visit.state().step).toBe(tab.visit.state().step);
});
