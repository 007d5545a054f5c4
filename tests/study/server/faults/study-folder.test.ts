import { chmodSync, mkdirSync, renameSync, rmSync, statSync, truncateSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { DatabaseSync } from '@photostructure/sqlite';
import { describe, expect, onTestFinished, test } from 'vitest';
import { openStudyStore } from '../../../../src/study/server/sqlite/study-store';
import { hasFileModes, movesOpenFiles } from '../../../platform';
import { reportFigures } from '../../../reliability/report-figures';
import { directoryWith } from '../../../temporary-directory';
import { paperPlan } from '../../model/studies';
import { experimenter, servedFolder } from '../running-studies';

/** Serves the studies of this folder; `add` adds a study. */
async function started(directory: string) {
  const served = await servedFolder(directory);
  const add = async (id: string) => {
    const response = await fetch(`${served.origin}/api/studies`, {
      method: 'POST',
      headers: { authorization: `Bearer ${experimenter}`, 'content-type': 'application/json' },
      body: JSON.stringify({ plan: paperPlan({ id }), simulated: false }),
    });
    return { status: response.status, error: ((await response.json()) as { error?: string }).error };
  };
  return { ...served, add };
}

const modeOf = (path: string) => statSync(path).mode & 0o777;
const files = ['studies.db', 'studies.db-wal', 'studies.db-shm', 'studies.lock'];

describe('the folder of the studies', () => {
  test.skipIf(!hasFileModes)('is made for the account of the server alone, with every file in it', async () => {
    const directory = join(directoryWith(), 'new');
    const { lines } = await started(directory);
    expect(lines).toEqual([]);
    expect(modeOf(directory)).toBe(0o700);
    for (const file of files) expect(modeOf(join(directory, file)), file).toBe(0o600);
  });

  test.skipIf(!hasFileModes)('is closed to others at the start, and the log says so', async () => {
    const directory = join(directoryWith(), 'open');
    mkdirSync(directory);
    openStudyStore(join(directory, 'studies.db')).close();
    writeFileSync(join(directory, 'experimenter-token'), 'an old token');
    chmodSync(directory, 0o755);
    chmodSync(join(directory, 'studies.db'), 0o644);
    chmodSync(join(directory, 'experimenter-token'), 0o640);
    const { lines } = await started(directory);
    expect(lines).toEqual([
      `study: ${directory} was open to other accounts of this machine (mode 0755); its mode is 0700 now.`,
      `study: ${directory}/studies.db was open to other accounts of this machine (mode 0644); its mode is 0600 now.`,
      `study: ${directory}/experimenter-token was open to other accounts of this machine (mode 0640); its mode is 0600 now.`,
    ]);
    expect(modeOf(directory)).toBe(0o700);
    for (const file of [...files, 'experimenter-token']) expect(modeOf(join(directory, file)), file).toBe(0o600);
    reportFigures('study-folder', { 'files open to others after the start': 0 });
  });

  test.skipIf(!movesOpenFiles)('is answered with 507 and a log line while it is deleted or replaced', async () => {
    const directory = join(directoryWith(), 'studies');
    const { add, lines } = await started(directory);
    expect((await add('before')).status).toBe(201);
    renameSync(directory, `${directory}-moved`);
    const deleted = [await add('gone-1'), await add('gone-2')];
    const sentence = 'the folder of the studies was deleted or replaced. Put it back, or restart the server';
    expect(deleted).toEqual([1, 2].map(() => ({ status: 507, error: sentence })));
    expect(lines).toEqual([`study: ${sentence} (${directory}/studies.db was deleted)`]);
    mkdirSync(directory);
    openStudyStore(join(directory, 'studies.db')).close();
    expect(await add('gone-3')).toEqual({ status: 507, error: sentence });
    rmSync(directory, { recursive: true });
    renameSync(`${directory}-moved`, directory);
    expect((await add('after')).status).toBe(201);
    reportFigures('study-folder', { 'writes acknowledged into a file that was deleted or replaced': '0 of 3' });
  });

  test.skipIf(!movesOpenFiles)('is answered with 507 when its log alone is deleted, too', async () => {
    const directory = directoryWith();
    const { add, lines } = await started(directory);
    rmSync(join(directory, 'studies.db-wal'));
    expect((await add('gone')).status).toBe(507);
    expect(lines).toEqual([expect.stringContaining('studies.db-wal was deleted')]);
  });

  test('is refused when another server uses it', { tags: ['full'] }, async () => {
    const directory = directoryWith();
    const first = await started(directory);
    await expect(started(directory)).rejects.toThrow(
      `Another server uses the folder ${directory}. Stop it, or name another folder with --studies.`,
    );
    await first.stop();
    const second = await started(directory);
    expect((await second.add('again')).status).toBe(201);
  });
});

describe('a database that cannot be opened is refused with its file and what to do', () => {
  const studied = () => {
    const directory = directoryWith();
    const file = join(directory, 'studies.db');
    const store = openStudyStore(file);
    for (let number = 0; number < 20; number++) {
      store.plans.add(paperPlan({ id: `study-${number}` }), { simulated: false, at: 1e9 });
    }
    store.close();
    return { directory, file };
  };
  const sql = (file: string, text: string) => {
    const database = new DatabaseSync(file);
    database.exec(text);
    database.close();
  };

  test('when it is no database', async () => {
    const directory = directoryWith({ 'studies.db': 'no database, but some text '.repeat(400) });
    await expect(started(directory)).rejects.toThrow(
      /studies\.db is damaged or not a database \(file is not a database\)\. Restore a copy/,
    );
  });

  test('when its end is missing', async () => {
    const { directory, file } = studied();
    truncateSync(file, statSync(file).size / 2);
    await expect(started(directory)).rejects.toThrow(/studies\.db is damaged.*[Rr]estore a copy/);
  });

  test('when it is of a newer version', async () => {
    const { directory, file } = studied();
    sql(file, 'PRAGMA user_version = 99');
    await expect(started(directory)).rejects.toThrow(
      /studies\.db has version 99, and this server knows versions up to \d+: install the version of the program/,
    );
  });

  test('when it is of another program', async () => {
    const directory = directoryWith();
    sql(join(directory, 'studies.db'), 'CREATE TABLE bookmarks (url TEXT)');
    await expect(started(directory)).rejects.toThrow(/studies\.db is the database of another program/);
  });

  test('when another program holds its lock, after 5 s', { tags: ['full'] }, async () => {
    const directory = directoryWith();
    const other = new DatabaseSync(join(directory, 'studies.db'));
    onTestFinished(() => other.close());
    other.exec('BEGIN EXCLUSIVE');
    await expect(started(directory)).rejects.toThrow(
      /studies\.db is locked by another program \(database is locked\)\. End that program/,
    );
  });

  test('when another program writes to it while the server has news to write', async () => {
    const { directory, file } = studied();
    const other = new DatabaseSync(file);
    onTestFinished(() => other.close());
    other.exec('BEGIN IMMEDIATE');
    await expect(started(directory)).rejects.toThrow(
      /studies\.db cannot be written: another program holds the lock of the database.*then start the server again/,
    );
    other.exec('ROLLBACK');
    expect((await (await started(directory)).add('new')).status).toBe(201);
  });

  test.skipIf(!hasFileModes || process.getuid?.() === 0)('when its folder may not be written', async () => {
    const directory = directoryWith();
    chmodSync(directory, 0o500);
    onTestFinished(() => chmodSync(directory, 0o700));
    await expect(started(directory)).rejects.toThrow(
      `The folder ${directory} cannot be used (EACCES: permission denied`,
    );
  });
});
