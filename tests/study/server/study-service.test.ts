import { statSync } from 'node:fs';
import { join } from 'node:path';
import { DatabaseSync } from '@photostructure/sqlite';
import { expect, onTestFinished, test, vi } from 'vitest';
import { openStudyStore } from '../../../src/study/server/sqlite/study-store';
import { hasFileModes } from '../../platform';
import { until } from '../../relay/running-relay';
import { directoryWith } from '../../temporary-directory';
import { paperPlan } from '../model/studies';
import { experimenter, servedFolder, testSoftware } from './running-studies';

const day = 86_400;

test('the first start draws a token readable by its owner alone; the next keeps it', async () => {
  const directory = join(directoryWith(), 'new');
  const first = await servedFolder(directory, null);
  const token = first.savedToken as string;
  expect(token.length).toBeGreaterThanOrEqual(32);
  if (hasFileModes) expect(statSync(first.tokenFile as string).mode & 0o777).toBe(0o600);
  await first.stop();
  const second = await servedFolder(directory, null);
  const asked = (authorization: string) => fetch(`${second.origin}/api/studies`, { headers: { authorization } });
  expect((await asked(`Bearer ${token}`)).status).toBe(200);
  expect((await asked('Bearer another-token-altogether')).status).toBe(401);
  expect((await fetch(`${second.origin}/anything`)).status).toBe(404);
});

/** Returns a directory with a study that P01 and P02 have begun. */
function begunStudy() {
  const directory = directoryWith();
  const file = join(directory, 'studies.db');
  const store = openStudyStore(file);
  store.plans.add(paperPlan(), { simulated: false, at: 1e9 });
  for (const participant of ['P01', 'P02']) store.places.claim('paper', participant, 1e9);
  store.software.note(testSoftware.exportedBy, 1e9);
  store.close();
  return { directory, file };
}

test('a failed deletion after the retention date ends no server: it is logged and repeated hourly', {
  tags: ['full'],
}, async () => {
  vi.useFakeTimers({ toFake: ['setInterval', 'clearInterval'] });
  onTestFinished(() => {
    vi.useRealTimers();
  });
  const { directory, file } = begunStudy();
  const database = new DatabaseSync(file);
  // The trigger refuses changes of P01 as a full disk would.
  database.exec(`CREATE TRIGGER full BEFORE UPDATE ON participants WHEN old.participant = 'P01'
    BEGIN SELECT raise(ABORT, 'database or disk is full'); END`);
  const late = await servedFolder(directory, experimenter, 1e9 + 366 * day);
  const { lines } = late;
  const refused =
    'study "paper": P01 is past the retention date and could not be deleted, which is tried again within the hour: database or disk is full';
  expect(lines).toEqual([refused, 'study "paper": P02 is past the retention date, 0 records deleted']);
  vi.advanceTimersByTime(3_600_000);
  await until('the second try', () => lines.length > 2);
  expect(lines.slice(2)).toEqual([refused]);
  database.exec('DROP TRIGGER full');
  database.close();
  vi.advanceTimersByTime(3_600_000);
  await until('the third try', () => lines.length > 3);
  expect(lines.slice(3)).toEqual(['study "paper": P01 is past the retention date, 0 records deleted']);
  expect((await fetch(`${late.origin}/api/studies/paper`)).status).toBe(200);
});
