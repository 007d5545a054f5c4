import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gunzipSync } from 'node:zlib';
import { DatabaseSync } from '@photostructure/sqlite';
import { describe, expect, onTestFinished, test } from 'vitest';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { openStudyStore } from '../../../src/study/server/sqlite/study-store';
import { unpacked } from '../../../src/study/server/study-storage';
import { reportFigures } from '../../reliability/report-figures';
import { directoryWith } from '../../temporary-directory';
import { latencyPlan, session } from '../model/studies';
import { withoutInvitations, withoutPlanVersions } from './older-databases';
import { type Anything, experimenter, servedStudies } from './running-studies';
import { asSent } from './stored-studies';

const now = 1_800_000_000;
const plan = latencyPlan();
const later = latencyPlan({ title: 'A body that follows much later' });

/** Returns a database with the study of three latencies, which P02 has finished and from which P03 has withdrawn. */
function begunStudy() {
  const file = join(directoryWith(), 'studies.db');
  const store = openStudyStore(file);
  store.plans.add(plan, { simulated: false, at: now });
  const { token, withdrawalCode } = store.places.claim('latency', 'P02', now);
  const p02 = session(scheduleFor(plan, 'P02'));
  p02.doUntil(({ kind }) => kind === 'end');
  store.records.store('latency', 'P02', p02.records, now);
  store.deletion.delete('latency', 'P03', 'withdrawn', now);
  store.close();
  return { file, token, withdrawalCode: withdrawalCode as string, records: p02.records };
}

/** Opens a database that an older version wrote. */
function broughtUpToDate(file: string, older: string) {
  const database = new DatabaseSync(file);
  database.exec(older);
  database.close();
  const store = openStudyStore(file);
  onTestFinished(() => store.close());
  return store;
}

test('a database from before invitations gives each place one, and loses nothing', () => {
  const { file, token, withdrawalCode, records } = begunStudy();
  const store = broughtUpToDate(file, withoutInvitations);
  const invitations = store.overview('latency', now).map(({ invitation }) => invitation);
  expect(invitations[2]).toBeNull();
  const given = invitations.filter((invitation) => invitation !== null);
  expect(new Set(given).size).toBe(17);
  for (const invitation of given) expect(invitation).toMatch(/^(\w{4}-){3}\w{4}$/);
  expect(store.places.acceptsInvitation('latency', 'P01', given[0] as string)).toBe(true);
  expect(store.places.acceptsInvitation('latency', 'P04', given[0] as string)).toBe(false);
  expect(store.places.holds('latency', 'P02', token)).toBe(true);
  expect(store.records.all('latency').map(asSent)).toEqual(records);
  expect(store.deletion.withdraw('latency', withdrawalCode, now)).toMatchObject({ participant: 'P02' });
});

test('a database from before versions of plans keeps every plan and participant, as version 1', () => {
  const { file, token, records } = begunStudy();
  const store = broughtUpToDate(file, withoutPlanVersions);
  expect(store.plans.get('latency')).toMatchObject({
    ...{ plan, version: 1, createdAt: now },
    versions: [{ version: 1, since: now, participants: ['P02', 'P03'] }],
  });
  expect(store.records.all('latency').map(asSent)).toEqual(records);
  expect(store.places.holds('latency', 'P02', token)).toBe(true);
  expect(store.plans.add(later, { simulated: false, newVersion: true, at: now }).version).toBe(2);
  expect(store.plans.planFor('latency', 'P02')).toEqual(plan);
  expect(store.plans.planFor('latency', 'P01')).toEqual(later);
});

/**
 * The database that the first version of the program left, with what its pages had sent. Participants P01 and P02 of
 * the study "paper" have finished and begun, P07 has withdrawn. P01 of "pairs" plays archery in pairs, which plans of
 * today may not ask for.
 */
describe('a database that the first version of the program wrote', () => {
  const golden = (name: string) => readFileSync(new URL(`../../golden/${name}`, import.meta.url));
  const sent = JSON.parse(golden('first-studies.json').toString()) as Anything;

  async function served() {
    const file = join(directoryWith(), 'studies.db');
    writeFileSync(file, gunzipSync(golden('first-studies.db.gz')));
    return servedStudies({ file });
  }

  test('has every record, recording, token, command and receipt', async () => {
    const { store } = await served();
    let kept = 0;
    for (const participant of ['P01', 'P02']) {
      const { token, progress, records } = sent[participant];
      const own = store.records.all('paper', participant).filter(({ id }) => !id.startsWith('experimenter-'));
      expect(own.map(asSent)).toEqual(records);
      kept += own.length;
      expect(store.places.progress('paper', participant)).toEqual(progress);
      expect(store.places.holds('paper', participant, token)).toBe(true);
    }
    expect(store.records.all('paper', 'P02').at(-1)).toMatchObject({
      author: 'experimenter',
      body: { type: 'remark' },
    });
    expect(store.commands.after('paper', 'P02', 0)).toMatchObject([{ command: { type: 'pause' } }]);
    expect(store.motion.all('paper').map(unpacked)).toEqual([{ participant: 'P01', ...sent.motion }]);
    expect(store.deletion.receipts('paper')).toMatchObject([{ participant: 'P07', reason: 'withdrawn' }]);
    reportFigures('first-folder', {
      'records kept': `${kept} of ${sent.P01.records.length + sent.P02.records.length}`,
    });
  });

  test('takes what its pages send once more, and goes on', async () => {
    const { ask } = await served();
    for (const participant of ['P01', 'P02']) {
      const { token, progress, records } = sent[participant];
      const place = `/api/studies/paper/participants/${participant}`;
      const { status, json } = await ask('POST', `${place}/records`, { token, json: { records } });
      expect([status, json.acknowledged.length]).toEqual([200, records.length]);
      expect((await ask('PUT', `${place}/progress`, { token, json: progress })).status).toBe(204);
      expect((await ask('GET', `${place}/export`, { token })).status).toBe(200);
    }
    expect((await ask('GET', '/api/studies/paper/export', { token: experimenter })).status).toBe(200);
  });

  test('keeps a study whose plan became invalid: listed, exported and deleted, but closed to newcomers', async () => {
    const { ask, store } = await served();
    const list = await ask('GET', '/api/studies', { token: experimenter });
    expect(list.json.studies.map(({ id }: Anything) => id)).toEqual(['paper', 'pairs']);
    const { token, withdrawalCode, records } = sent.pairs;
    const pairs = '/api/studies/pairs';
    for (const path of ['', '/participants', '/records', '/export', '/participants/P01/export']) {
      expect((await ask('GET', `${pairs}${path}`, { token: experimenter })).status, path).toBe(200);
    }
    expect((await ask('GET', `${pairs}/participants/P01/records`, { token })).json.records.map(asSent)).toEqual(
      records,
    );
    const claim = await ask('POST', `${pairs}/participants/P02/claim`, { token: experimenter, json: {} });
    expect([claim.status, claim.json.error]).toEqual([
      409,
      'the plan of this study is of an older version of the program and no longer valid: tasks[0].groupSize: archery is played alone: ' +
        'expected 1. Its records can be exported and deleted. Give a study with another plan another id',
    ]);
    const receipt = await ask('POST', `${pairs}/withdraw`, { json: { code: withdrawalCode } });
    expect([receipt.status, receipt.json.records]).toEqual([200, records.length]);
    expect(store.records.all('pairs')).toEqual([]);
    reportFigures('first-folder', { 'its studies that cannot be read': 0 });
  });
});
