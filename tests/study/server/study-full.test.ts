import { spawn } from 'node:child_process';
import { readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { DatabaseSync } from '@photostructure/sqlite';
import { describe, expect, onTestFinished, test } from 'vitest';
import { recordVersion, type StudyRecord } from '../../../src/study/model/records/study-record';
import { directoryWith } from '../../temporary-directory';
import { completed, paperPlan } from '../model/studies';
import { now } from './running-studies';
import { asSent, opened } from './stored-studies';

const root = fileURLToPath(new URL('../../..', import.meta.url));

const remark = (number: number): StudyRecord => ({
  ...{ version: recordVersion, study: 'paper', participant: 'P01', simulated: false, at: number },
  ...{ id: `event-${number}`, kind: 'event', body: { type: 'remark', text: `${number} `.repeat(250) } },
});

describe('storage that is full', () => {
  test('refuses in a sentence, keeps what was acknowledged, and takes the rest once there is room', () => {
    const file = join(directoryWith(), 'studies.db');
    const { store: full } = opened(file, { maxBytes: 256 * 1024 });
    full.plans.add(paperPlan(), { simulated: false, at: now });
    full.records.store('paper', 'P01', completed('P01', { motion: true }).slice(0, 1), now);
    let stored = 1;
    const fill = () => {
      for (; stored < 2000; stored++) full.records.store('paper', 'P01', [remark(stored)], now);
    };
    expect(fill).toThrow('the disk of the server is full');
    expect(full.records.all('paper', 'P01')).toHaveLength(stored);
    full.close();
    const { store: roomy } = opened(file);
    expect(roomy.records.all('paper', 'P01').map(asSent).at(-1)).toEqual(remark(stored - 1));
    roomy.records.store('paper', 'P01', [remark(stored)], now);
    expect(roomy.records.all('paper', 'P01')).toHaveLength(stored + 1);
  });

  test('by the system’s limit on files loses no acknowledged record, and the file stays sound', {
    timeout: 120_000,
  }, async () => {
    const file = join(directoryWith(), 'studies.db');
    const { store: before } = opened(file);
    before.plans.add(paperPlan(), { simulated: false, at: now });
    before.records.store('paper', 'P01', completed('P01', { motion: true }).slice(0, 1), now);
    before.close();
    // In blocks of 1024 bytes: a little more than the file is now. SIGXFSZ is ignored, as servers do: writes fail
    // instead.
    const blocks = Math.ceil(statSync(file).size / 1024) + 1000;
    const writer = spawn(
      'bash',
      [
        '-c',
        `trap '' XFSZ; ulimit -f ${blocks}; exec "$0" "$@"`,
        process.execPath,
        '--import',
        'tsx',
        'tests/study/server/faults/study-writer.ts',
        file,
        '1',
      ],
      { cwd: root, stdio: ['ignore', 'pipe', 'pipe'] },
    );
    let said = '';
    let complaint = '';
    writer.stdout.on('data', (chunk) => (said += chunk));
    writer.stderr.on('data', (chunk) => (complaint += chunk));
    const code = await new Promise((resolve) => writer.on('close', resolve));
    expect(code, 'the writer ends by the refusal').not.toBe(0);
    expect(complaint).toMatch(/full|disk|I\/O/i);
    const acknowledged = said.split('\n').filter(Boolean);
    expect(acknowledged.length).toBeGreaterThan(20);
    const { store: after } = opened(file);
    const ids = new Set(after.records.all('paper', 'P01').map(({ id }) => id));
    expect(acknowledged.filter((id) => !ids.has(id))).toEqual([]);
    after.records.store('paper', 'P01', [remark(9_000_000)], now);
  });
});

describe('deletion by the code', () => {
  const conspicuous = 'a-very-conspicuous-word';

  /** Returns the bytes of every file of the folder. */
  const bytesOf = (directory: string) =>
    readdirSync(directory, { recursive: true, encoding: 'utf8' })
      .map((name) => join(directory, name))
      .filter((path) => statSync(path).isFile())
      .map((path) => ({ path, bytes: readFileSync(path) }));

  const tracesOf = (directory: string) =>
    bytesOf(directory).flatMap(({ path, bytes }) => (bytes.includes(conspicuous) ? [path] : []));

  test('leaves bytes in the log only while another program reads the database', () => {
    const directory = directoryWith();
    const { store } = opened(join(directory, 'studies.db'));
    store.plans.add(paperPlan(), { simulated: false, at: now });
    const { withdrawalCode } = store.places.claim('paper', 'P01', now);
    expect(store.places.claim('paper', 'P02', now).withdrawalCode).not.toBe(withdrawalCode);
    store.records.store('paper', 'P01', completed('P01', { motion: true }), now);
    store.records.addRemark('paper', 'P01', conspicuous, now);
    const reader = new DatabaseSync(join(directory, 'studies.db'));
    onTestFinished(() => reader.close());
    reader.exec('BEGIN; SELECT count(*) FROM records');
    store.deletion.withdraw('paper', withdrawalCode as string, now);
    expect(store.purgeDeleted()).toBe(false);
    expect(tracesOf(directory)).not.toEqual([]);
    reader.exec('COMMIT');
    expect(store.purgeDeleted()).toBe(true);
    expect(tracesOf(directory)).toEqual([]);
    store.close();
    expect(tracesOf(directory)).toEqual([]);
  });
});
