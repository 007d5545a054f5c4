import { spawn } from 'node:child_process';
import { readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { DatabaseSync } from '@photostructure/sqlite';
import { scheduleFor } from 'threepoint-study/model/plan/schedule';
import { recordVersion, type StudyRecord } from 'threepoint-study/model/records/study-record';
import { openStudyStore } from 'threepoint-study/server/storage/study-store';
import { describe, expect, onTestFinished, test } from 'vitest';
import { directoryWith } from '../../temporary-directory';
import { paperPlan, session } from '../model/studies';

const now = 1_800_000_000;
const root = fileURLToPath(new URL('../../..', import.meta.url));

function consented(participant: string): StudyRecord[] {
  const schedule = scheduleFor(paperPlan(), participant);
  const one = session(schedule);
  one.tell({ type: 'consent', version: schedule.consentVersion, motion: true });
  one.doUntil(({ kind }) => kind === 'end');
  return one.records;
}

function opened(file: string, maxBytes?: number) {
  const store = openStudyStore(file, maxBytes === undefined ? {} : { maxBytes });
  let open = true;
  onTestFinished(() => {
    if (open) store.close();
  });
  return {
    ...store,
    close() {
      open = false;
      store.close();
    },
  };
}

const remark = (number: number): StudyRecord => ({
  ...{ version: recordVersion, study: 'paper', participant: 'P01', simulated: false, at: number },
  ...{ id: `event-${number}`, kind: 'event', body: { type: 'remark', text: `${number} `.repeat(250) } },
});

describe('storage that is full', () => {
  test('refuses in a sentence, keeps what was acknowledged, and takes the rest once there is room', () => {
    const file = join(directoryWith(), 'studies.db');
    const full = opened(file, 256 * 1024);
    full.plans.add(paperPlan(), { simulated: false, at: now });
    full.records.store('paper', 'P01', consented('P01').slice(0, 1), now);
    let stored = 1;
    const fill = () => {
      for (; stored < 2000; stored++) full.records.store('paper', 'P01', [remark(stored)], now);
    };
    expect(fill).toThrow('the disk of the server is full: nothing was stored');
    expect(full.records.all('paper', 'P01')).toHaveLength(stored);
    full.close();
    const roomy = opened(file);
    expect(roomy.records.all('paper', 'P01').at(-1)).toEqual(remark(stored - 1));
    roomy.records.store('paper', 'P01', [remark(stored)], now);
    expect(roomy.records.all('paper', 'P01')).toHaveLength(stored + 1);
  });

  test('by the limit of the system on files: no acknowledged record goes, and the file stays sound', {
    timeout: 120_000,
  }, async () => {
    const file = join(directoryWith(), 'studies.db');
    const before = opened(file);
    before.plans.add(paperPlan(), { simulated: false, at: now });
    before.records.store('paper', 'P01', consented('P01').slice(0, 1), now);
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
    const after = opened(file);
    const ids = new Set(after.records.all('paper', 'P01').map(({ id }) => id));
    expect(acknowledged.filter((id) => !ids.has(id))).toEqual([]);
    after.records.store('paper', 'P01', [remark(9_000_000)], now);
  });
});

describe('deletion by the code', () => {
  const conspicuous = 'a-very-conspicuous-word';

  /** Every file of the folder, whole. */
  const bytesOf = (directory: string) =>
    readdirSync(directory, { recursive: true, encoding: 'utf8' })
      .map((name) => join(directory, name))
      .filter((path) => statSync(path).isFile())
      .map((path) => ({ path, bytes: readFileSync(path) }));

  const tracesOf = (directory: string, traces: readonly (string | Buffer)[]) =>
    bytesOf(directory).flatMap(({ path, bytes }) => (traces.some((trace) => bytes.includes(trace)) ? [path] : []));

  test('leaves no byte of the participant in any file: records, progress, commands, motion, tokens', () => {
    const directory = directoryWith();
    const store = opened(join(directory, 'studies.db'));
    store.plans.add(paperPlan(), { simulated: false, at: now });
    const { withdrawalCode } = store.places.claim('paper', 'P01', now);
    const other = store.places.claim('paper', 'P02', now);
    const motion = JSON.stringify({ frames: Array.from({ length: 4000 }, (_, at) => Math.sin(at * 7.3)) });
    for (const participant of ['P01', 'P02']) {
      const records = consented(participant).map((record) =>
        record.kind === 'demographics'
          ? { ...record, body: { ...record.body, major: `${conspicuous} ${participant}` } }
          : record,
      );
      store.records.store('paper', participant, records, now);
    }
    store.motion.store('paper', 'P01', 'archery/1/trial-1@1.1:trial', motion, now);
    store.records.addRemark('paper', 'P01', `${conspicuous} P01, said the experimenter`, now);
    store.commands.add('paper', 'P01', { type: 'stop', by: 'experimenter', reason: `${conspicuous} P01 stops` }, now);
    // The middle of the compressed recording, as it lies on the disk.
    const packed = gzipSync(motion).subarray(2000, 2040);
    const traces = [`${conspicuous} P01`, packed];
    expect(tracesOf(directory, traces)).not.toEqual([]);
    expect(tracesOf(directory, [packed])).not.toEqual([]);

    expect(store.deletion.withdraw('paper', withdrawalCode as string, now)).toMatchObject({ motionFiles: 1 });
    expect(tracesOf(directory, traces)).toEqual([]);
    expect(tracesOf(directory, [`${conspicuous} P02`])).not.toEqual([]);
    store.close();
    expect(tracesOf(directory, traces)).toEqual([]);
    expect(other.withdrawalCode).not.toBe(withdrawalCode);
  });

  test('leaves bytes in the log only while another program reads the database', () => {
    const directory = directoryWith();
    const store = opened(join(directory, 'studies.db'));
    store.plans.add(paperPlan(), { simulated: false, at: now });
    const { withdrawalCode } = store.places.claim('paper', 'P01', now);
    store.records.store('paper', 'P01', consented('P01'), now);
    store.records.addRemark('paper', 'P01', conspicuous, now);
    const reader = new DatabaseSync(join(directory, 'studies.db'));
    onTestFinished(() => reader.close());
    reader.exec('BEGIN; SELECT count(*) FROM records');
    store.deletion.withdraw('paper', withdrawalCode as string, now);
    expect(store.purgeDeleted()).toBe(false);
    expect(tracesOf(directory, [conspicuous])).not.toEqual([]);
    reader.exec('COMMIT');
    expect(store.purgeDeleted()).toBe(true);
    expect(tracesOf(directory, [conspicuous])).toEqual([]);
  });
});
