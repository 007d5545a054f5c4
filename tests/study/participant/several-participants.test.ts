import { expect, test } from 'vitest';
import { type Schedule, scheduleFor } from '../../../src/study/model/plan/schedule';
import type { StoredRecord } from '../../../src/study/model/records/study-record';
import { recordFlags } from '../../../src/study/model/tables/record-flags';
import { type RandomSource, randomSource } from '../../../src/study/simulation/random-source';
import { aWomanOf26 } from '../model/studies';
import { agree, canStart, choose, measure } from './participant-steps';
import { browser, type Tab } from './study-browser';
import { type StudyServer, studyServer } from './study-server';

const people = ['P01', 'P02', 'P03'] as const;

/** The number of each participant's trials is their score, so that a result at another one is found. */
const scoreOf = (participant: string): number => 10 * Number(participant.slice(1));

async function entered(server: StudyServer, participant: string): Promise<Tab> {
  const states = await server.experimenter.participants('paper');
  const invitation = states.find((state) => state.participant === participant)?.invitation ?? null;
  const tab = await browser(server).open({ participant, invitation });
  await agree(tab);
  expect(tab.display.asked('demographics').done(aWomanOf26)).toBeNull();
  await measure(tab);
  return tab;
}

/** Does what the page of a participant asks for next. */
async function actOnce(tab: Tab, participant: string): Promise<void> {
  const { display, host } = tab;
  const { shown } = display;
  if (tab.visit.state().step?.endsWith('calibration') && shown !== 'paused') await measure(tab);
  else if (shown === 'paused') display.press('resume');
  else if (shown.startsWith('question-')) {
    choose(tab, Number(participant.slice(1)));
    display.press(display.screen?.buttons.some(({ id }) => id === 'submit') ? 'submit' : 'next');
  } else if (shown === 'rest') tab.pass(61);
  else if (host.games.archery.running) {
    host.games.archery.hit(scoreOf(participant));
    tab.draw(3);
  } else {
    await canStart(tab);
    if (display.screen?.buttons.some(({ id, look }) => id === 'start' && look === 'primary')) display.press('start');
    tab.draw(1);
  }
}

/** Gives a participant a command about what the experimenter's page shows of them; resolves with its reason. */
async function commandOnce(server: StudyServer, participant: string, random: RandomSource): Promise<string | null> {
  const states = await server.experimenter.participants('paper');
  const step = states.find((state) => state.participant === participant)?.session?.step ?? '';
  const [task, block] = step.split('/');
  if (random.uniform() < 0.5 || task !== 'archery' || block === undefined) {
    const type = random.uniform() < 0.5 ? 'pause' : 'resume';
    await server.experimenter.command('paper', participant, { type });
    return null;
  }
  const reason = `mishap of ${participant} at ${random.uniform()}`;
  const of = { task, block: Number(block) };
  await server.experimenter.command('paper', participant, { type: 'void-block', reason, repeat: true, of });
  return reason;
}

/** Compares each record of a participant with their schedule and with what they did. */
function expectOwn(records: readonly StoredRecord[], participant: string, schedule: Schedule): void {
  for (const record of records) {
    expect(record).toMatchObject({ participant, author: 'participant' });
    if (record.kind === 'trial') expect(record.body.outcome.score).toBe(scoreOf(participant));
    if (record.kind === 'answers') {
      const given = new Set(Object.values(record.body.answers));
      expect([...given]).toEqual([Number(participant.slice(1))]);
    }
    if (record.kind !== 'trial' && record.kind !== 'answers') continue;
    const { place, condition } = record.body;
    const due = schedule.steps.find((step) => step.kind === 'trial' && step.block === place.block);
    if (condition !== null) expect(due).toMatchObject({ condition });
  }
}

test('three participants under simultaneous commands keep results apart, and each voided block is recorded once', {
  tags: ['full'],
}, async () => {
  const server = await studyServer();
  const random = randomSource(2460, 'three participants');
  const tabs = new Map<string, Tab>();
  for (const participant of people) tabs.set(participant, await entered(server, participant));
  const reasons: string[] = [];
  for (let turn = 0; turn < 90; turn++) {
    const participant = people[Math.floor(3 * random.uniform())] as string;
    const tab = tabs.get(participant) as Tab;
    const given = turn % 6 === 0 ? commandOnce(server, participant, random) : Promise.resolve(null);
    if (tab.visit.state().step?.startsWith('archery')) await actOnce(tab, participant);
    const [reason] = await Promise.all([given, ...[...tabs.values()].map((one) => one.visit.flow?.exchange())]);
    if (reason !== null) reasons.push(reason);
  }
  for (const tab of tabs.values()) {
    await tab.exchange();
    expect(tab.visit.state()).toMatchObject({ unsent: 0, unsaved: 0, online: true });
  }
  expect(reasons.length).toBeGreaterThan(3);
  // The clocks of these pages run apart from the server's.
  const all = server.store.records.all('paper').map((record) => ({ ...record, receivedAt: record.at }));
  expect(all.map(recordFlags(all)).filter(Boolean)).toEqual([]);
  for (const participant of people) {
    const records = all.filter((record) => record.participant === participant);
    expectOwn(records, participant, scheduleFor(server.plan, participant));
    for (const reason of reasons.filter((text) => text.includes(participant))) {
      const caused = records.filter(({ body }) => JSON.stringify(body).includes(reason));
      const remarks = records.filter(({ body }) => JSON.stringify(body).includes('"void-block\\" changed nothing'));
      expect(caused.length === 1 || remarks.length > 0, reason).toBe(true);
    }
    expect(records.filter(({ kind }) => kind === 'trial').length).toBeGreaterThan(1);
  }
});
