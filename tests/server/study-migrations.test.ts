import { join } from 'node:path';
import { DatabaseSync } from '@photostructure/sqlite';
import { expect, onTestFinished, test } from 'vitest';
import { openStudyStore } from '../../server/study-store';
import { scheduleFor } from '../../src/core/study/schedule';
import { latencyPlan, session } from '../core/study/studies';
import { directoryWith } from '../temporary-directory';
import { withoutInvitations, withoutPlanVersions } from './older-databases';

const now = 1_800_000_000;
const plan = latencyPlan();
const later = latencyPlan({ title: 'A body that follows much later' });

/** The study of three latencies in a database of its own, which P02 has finished and from which P03 has withdrawn. */
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

/** The database as an older version left it, opened by this one. */
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
  expect(store.places.invites('latency', 'P01', given[0] as string)).toBe(true);
  expect(store.places.invites('latency', 'P04', given[0] as string)).toBe(false);
  expect(store.places.holds('latency', 'P02', token)).toBe(true);
  expect(store.records.all('latency')).toEqual(records);
  expect(store.deletion.withdraw('latency', withdrawalCode, now)).toMatchObject({ participant: 'P02' });
});

test('a database from before versions of plans keeps every plan and participant, as version 1', () => {
  const { file, token, records } = begunStudy();
  const store = broughtUpToDate(file, withoutPlanVersions);
  expect(store.plans.get('latency')).toMatchObject({
    ...{ plan, version: 1, createdAt: now },
    versions: [{ version: 1, since: now, participants: ['P02', 'P03'] }],
  });
  expect(store.records.all('latency')).toEqual(records);
  expect(store.places.holds('latency', 'P02', token)).toBe(true);
  expect(store.plans.add(later, { simulated: false, newVersion: true, at: now }).version).toBe(2);
  expect(store.plans.planFor('latency', 'P02')).toEqual(plan);
  expect(store.plans.planFor('latency', 'P01')).toEqual(later);
});
