import { spawn } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { DatabaseSync } from '@photostructure/sqlite';
import { strFromU8, unzipSync } from 'fflate';
import { describe, expect, onTestFinished, test } from 'vitest';
import { exportZip } from '../../server/study-export';
import { unpacked } from '../../server/study-motion';
import { normalisedCode } from '../../server/study-schema';
import { openStudyStore, type StudyStore } from '../../server/study-store';
import { begin, reported } from '../../src/core/study/progress';
import { scheduleFor } from '../../src/core/study/schedule';
import type { StudyRecord } from '../../src/core/study/study-record';
import { paperPlan, session } from '../core/study/studies';
import { directoryWith } from '../temporary-directory';
import { testSoftware } from './running-studies';

const root = fileURLToPath(new URL('../..', import.meta.url));
const now = 1_800_000_000;
const day = 86_400;

function opened(file = join(directoryWith(), 'studies.db')): { store: StudyStore; file: string } {
  const store = openStudyStore(file);
  let open = true;
  const close = store.close;
  store.close = () => {
    if (open) close();
    open = false;
  };
  onTestFinished(() => store.close());
  return { store, file };
}

function withPaperStudy(options = { simulated: false }) {
  const { store, file } = opened();
  store.addStudy(paperPlan(), { ...options, at: now });
  return { store, file };
}

/** Everything that one participant does, consent to motion recording or not. */
function completed(participant = 'P01', { simulated = false, motion = false } = {}): StudyRecord[] {
  const schedule = scheduleFor(paperPlan(), participant);
  const one = session(schedule, simulated);
  one.tell({ type: 'consent', version: schedule.consentVersion, motion });
  one.doUntil(({ kind }) => kind === 'end');
  return one.records;
}

describe('the store', () => {
  test('gives back what it was given, after being closed and opened', () => {
    const { store, file } = withPaperStudy();
    const records = completed();
    expect(store.storeRecords('paper', 'P01', records, now)).toEqual(records.map(({ id }) => id));
    store.close();
    expect(opened(file).store.records('paper', 'P01')).toEqual(records);
  });

  test('keeps its log beside it (WAL)', () => {
    const { file } = withPaperStudy();
    expect(new DatabaseSync(file).prepare('PRAGMA journal_mode').get()).toMatchObject({ journal_mode: 'wal' });
  });

  test('stores once what is sent twice, and says so both times', () => {
    const { store } = withPaperStudy();
    const records = completed();
    store.storeRecords('paper', 'P01', records, now);
    expect(store.storeRecords('paper', 'P01', records, now + 5)).toHaveLength(records.length);
    expect(store.records('paper')).toHaveLength(records.length);
  });

  test('does not overwrite what it has', () => {
    const { store } = withPaperStudy();
    const records = completed();
    store.storeRecords('paper', 'P01', records, now);
    const changed = { ...(records[1] as StudyRecord), at: 7 };
    expect(() => store.storeRecords('paper', 'P01', [changed], now)).toThrow('has stored something else');
    expect(store.records('paper', 'P01')[1]).toEqual(records[1]);
  });

  test('stores a batch whole or not at all', () => {
    const { store } = withPaperStudy();
    const records = completed();
    const foreign = { ...(records.at(-1) as StudyRecord), participant: 'P02' };
    expect(() => store.storeRecords('paper', 'P01', [...records.slice(0, -1), foreign], now)).toThrow('is of P02');
    expect(store.records('paper')).toEqual([]);
  });

  test('stores nothing before consent, and takes consent to the shown text alone', () => {
    const { store } = withPaperStudy();
    const [consent, ...rest] = completed() as [StudyRecord, ...StudyRecord[]];
    expect(() => store.storeRecords('paper', 'P01', rest, now)).toThrow('has not consented');
    expect(() => store.addRemark('paper', 'P01', 'tall', now)).toThrow('has not consented');
    const old = { ...consent, body: { ...consent.body, version: '2001' } } as StudyRecord;
    expect(() => store.storeRecords('paper', 'P01', [old], now)).toThrow('consent is to text 2001');
    store.storeRecords('paper', 'P01', [consent, ...rest], now);
  });

  test('keeps simulated people and people apart', () => {
    const people = withPaperStudy().store;
    expect(() => people.storeRecords('paper', 'P01', completed('P01', { simulated: true }), now)).toThrow('of people');
    expect(() => people.addStudy(paperPlan(), { simulated: true, at: now })).toThrow('give this one another id');
    const simulated = withPaperStudy({ simulated: true }).store;
    expect(() => simulated.storeRecords('paper', 'P01', completed(), now)).toThrow('is simulated');
  });

  test('does not let the plan of a study change under its participants', () => {
    const { store } = withPaperStudy();
    store.addStudy(paperPlan({ title: 'Another title' }), { simulated: false, at: now });
    expect(store.study('paper').plan.title).toBe('Another title');
    store.claim('paper', 'P01', now);
    expect(() => store.addStudy(paperPlan(), { simulated: false, at: now })).toThrow('has begun');
    store.addStudy(paperPlan({ title: 'Another title' }), { simulated: false, at: now + 1 });
  });

  test('refuses a database from a later version', () => {
    const { store, file } = withPaperStudy();
    store.close();
    const database = new DatabaseSync(file);
    database.exec('PRAGMA user_version = 99');
    database.close();
    expect(() => openStudyStore(file)).toThrow('has version 99');
  });

  test('knows where each participant is', () => {
    const { store } = withPaperStudy();
    store.claim('paper', 'P02', now);
    store.saveProgress('paper', 'P02', { ...begin(scheduleFor(paperPlan(), 'P02')), step: 'consent' }, now);
    const [first, second] = store.overview('paper', now);
    expect(first).toMatchObject({ participant: 'P01', claimed: false, session: null });
    expect(second).toMatchObject({ participant: 'P02', claimed: true, session: { step: 'consent', reportedAt: now } });
    expect(store.progress('paper', 'P02')?.step).toBe('consent');
  });

  test('counts the time of a step on by its own clock, whatever that of the device says', () => {
    const { store } = withPaperStudy();
    store.claim('paper', 'P01', now);
    const one = session(scheduleFor(paperPlan(), 'P01'));
    one.doUntil(({ kind }) => kind === 'rest');
    one.wait(20);
    // The device's clock is an hour ahead of the server's.
    store.saveProgress('paper', 'P01', reported(one.progress, one.now), one.now - 3600);
    const [state] = store.overview('paper', one.now - 3600 + 15);
    expect(state?.session?.remainingSeconds).toBeCloseTo(25, 6);
    expect(store.progress('paper', 'P01', one.now - 3600 + 15)?.elapsed).toBeCloseTo(35, 6);
    expect(store.progress('paper', 'P01')?.elapsed).toBeCloseTo(20, 6);
  });

  test('still opens progress that tells since when the clock of the device runs, as older pages did', () => {
    const { store } = withPaperStudy();
    const one = session(scheduleFor(paperPlan(), 'P01'));
    one.doUntil(({ kind }) => kind === 'rest');
    store.saveProgress('paper', 'P01', one.progress, one.now);
    expect(store.overview('paper', one.now + 15)[0]?.session?.remainingSeconds).toBeCloseTo(45, 6);
    expect(store.progress('paper', 'P01', one.now + 15)).toEqual(one.progress);
  });

  test('hands on commands in order, each once', () => {
    const { store } = withPaperStudy();
    const first = store.addCommand('paper', 'P01', { type: 'pause' }, now);
    store.addCommand('paper', 'P02', { type: 'start' }, now);
    store.addCommand('paper', 'P01', { type: 'resume' }, now);
    expect(store.commands('paper', 'P01', 0).map(({ command }) => command.type)).toEqual(['pause', 'resume']);
    expect(store.commands('paper', 'P01', first).map(({ command }) => command.type)).toEqual(['resume']);
  });
});

describe('a place in the study', () => {
  test('belongs to the first device that claims it', () => {
    const { store } = withPaperStudy();
    const { token } = store.claim('paper', 'P01', now);
    expect(() => store.claim('paper', 'P01', now)).toThrow('taken by another device');
    expect(store.holds('paper', 'P01', token)).toBe(true);
    expect(store.holds('paper', 'P02', token)).toBe(false);
    expect(store.holds('paper', 'P01', `${token}x`)).toBe(false);
  });

  test('that is released goes to the next device; the withdrawal code stays', () => {
    const { store } = withPaperStudy();
    const first = store.claim('paper', 'P01', now);
    store.storeRecords('paper', 'P01', completed(), now);
    store.release('paper', 'P01');
    const second = store.claim('paper', 'P01', now);
    expect(store.holds('paper', 'P01', first.token)).toBe(false);
    expect(store.holds('paper', 'P01', second.token)).toBe(true);
    expect(second.withdrawalCode).toBeNull();
    expect(store.withdraw('paper', first.withdrawalCode as string, now)?.participant).toBe('P01');
  });

  test('of which nothing is recorded yet gives a withdrawal code again: the answer to the first claim may have been lost', () => {
    const { store } = withPaperStudy();
    const lost = store.claim('paper', 'P01', now).withdrawalCode as string;
    store.release('paper', 'P01');
    const { withdrawalCode } = store.claim('paper', 'P01', now);
    expect(withdrawalCode).toMatch(/^(\w{4}-){3}\w{4}$/);
    expect(withdrawalCode).not.toBe(lost);
    store.storeRecords('paper', 'P01', completed(), now);
    expect(store.withdraw('paper', lost, now)).toBeNull();
    expect(store.withdraw('paper', withdrawalCode as string, now)?.participant).toBe('P01');
  });

  test('keeps neither token nor code, only what proves them', () => {
    const { store, file } = withPaperStudy();
    const { token, withdrawalCode } = store.claim('paper', 'P01', now);
    store.close();
    const bytes = readFileSync(file).toString('latin1');
    expect(bytes).not.toContain(token);
    expect(bytes).not.toContain(withdrawalCode as string);
  });
});

describe('deleting', () => {
  const bytesOf = (file: string) => {
    const folder = join(file, '..');
    return readdirSync(folder)
      .map((name) => readFileSync(join(folder, name)).toString('latin1'))
      .join();
  };

  test('leaves a receipt and no trace in the file', () => {
    const { store, file } = withPaperStudy();
    store.claim('paper', 'P01', now);
    const records = completed();
    store.storeRecords('paper', 'P01', records, now);
    store.addRemark('paper', 'P01', 'wore a conspicuous hat', now);
    expect(bytesOf(file)).toContain('conspicuous hat');
    const receipt = store.deleteParticipant('paper', 'P01', 'experimenter', now + 9);
    expect(receipt).toEqual({
      number: 1,
      study: 'paper',
      participant: 'P01',
      reason: 'experimenter',
      records: records.length + 1,
      motionFiles: 0,
      at: now + 9,
    });
    expect(store.records('paper')).toEqual([]);
    expect(store.receipts('paper')).toEqual([receipt]);
    expect(bytesOf(file)).not.toContain('conspicuous hat');
    expect(bytesOf(file)).not.toContain('Computer science');
  });

  test('concerns one participant alone', () => {
    const { store } = withPaperStudy();
    for (const participant of ['P01', 'P02']) {
      store.storeRecords('paper', participant, completed(participant), now);
    }
    store.deleteParticipant('paper', 'P01', 'experimenter', now);
    expect(store.records('paper').every(({ participant }) => participant === 'P02')).toBe(true);
    expect(store.records('paper')).toHaveLength(completed('P02').length);
  });

  test('by the withdrawal code, however it is typed, and for good', () => {
    const { store } = withPaperStudy();
    const { withdrawalCode } = store.claim('paper', 'P01', now);
    store.storeRecords('paper', 'P01', completed(), now);
    expect(store.withdraw('paper', '0000-0000-0000-0000', now)).toBeNull();
    const typed = (withdrawalCode as string).toLowerCase().replaceAll('-', ' ');
    expect(store.withdraw('paper', typed, now)).toMatchObject({ participant: 'P01', reason: 'withdrawn' });
    expect(() => store.claim('paper', 'P01', now)).toThrow('has withdrawn');
    expect(() => store.storeRecords('paper', 'P01', completed(), now)).toThrow('has withdrawn');
    expect(store.withdraw('paper', withdrawalCode as string, now)).toBeNull();
  });

  test('takes o for 0 and l for 1 in a code, since they look alike', () => {
    expect(normalisedCode('o1lI 23ab-cdef-ghjk')).toBe('0111-23AB-CDEF-GHJK');
  });

  test('happens by itself after the retention date, not before', () => {
    const { store } = withPaperStudy();
    store.claim('paper', 'P01', now);
    store.storeRecords('paper', 'P01', completed(), now);
    const expired = (at: number) => store.deleteExpired(at, (_, error) => expect(error).toBeNull());
    expect(expired(now + 365 * day)).toEqual([]);
    expect(expired(now + 365 * day + 1)).toMatchObject([{ participant: 'P01', reason: 'retention' }]);
    expect(store.records('paper')).toEqual([]);
    expect(expired(now + 366 * day)).toEqual([]);
  });
});

describe('tracked frames', () => {
  test('are kept with consent to them alone', () => {
    const { store } = withPaperStudy();
    store.storeRecords('paper', 'P01', completed('P01'), now);
    expect(() => store.storeMotion('paper', 'P01', 'archery/1/trial-1', '{}', now)).toThrow('motion recording');
    store.storeRecords('paper', 'P02', completed('P02', { motion: true }), now);
    store.storeMotion('paper', 'P02', 'archery/1/trial-1', '{"frames":[]}', now);
    expect(store.motion('paper').map(unpacked)).toEqual([
      { participant: 'P02', trial: 'archery/1/trial-1', text: '{"frames":[]}' },
    ]);
    expect(store.deleteParticipant('paper', 'P02', 'experimenter', now).motionFiles).toBe(1);
    expect(store.motion('paper')).toEqual([]);
  });

  test('are not kept in a study that does not ask for them', () => {
    const { store } = opened();
    store.addStudy(paperPlan({ consent: { ...paperPlan().consent, motion: null } }), { simulated: false, at: now });
    store.storeRecords('paper', 'P01', completed('P01', { motion: true }), now);
    expect(() => store.storeMotion('paper', 'P01', 'archery/1/trial-1', '{}', now)).toThrow('motion recording');
  });
});

describe('an export', () => {
  const contentOf = (store: StudyStore, participant?: string) => {
    const { plan, simulated, retentionUntil } = store.study('paper');
    const records = store.records('paper', participant);
    const motion = store.motion('paper', participant).map(unpacked);
    return { plan, simulated, records, motion, at: now, retentionUntil, software: testSoftware };
  };

  test('holds JSON, tidy tables and a codebook, of this participant alone', () => {
    const { store } = withPaperStudy();
    for (const participant of ['P01', 'P02']) store.storeRecords('paper', participant, completed(participant), now);
    const files = unzipSync(exportZip(contentOf(store, 'P01'), 'P01'));
    expect(Object.keys(files).toSorted()).toEqual(
      [
        'README.txt',
        'answers.csv',
        'checksums.sha256',
        'codebook.csv',
        'conditions.csv',
        'events.csv',
        'frame-times.csv',
        'hits.csv',
        'participants.csv',
        'pauses.csv',
        'plan.json',
        'planned.csv',
        'questions.csv',
        'records.json',
        'scale-definitions.csv',
        'scales.csv',
        'software.json',
        'trials.csv',
      ].map((name) => `paper-P01/${name}`),
    );
    const read = (name: string) => strFromU8(files[`paper-P01/${name}`] as Uint8Array);
    expect(JSON.parse(read('records.json')).records).toEqual(store.records('paper', 'P01'));
    expect(read('answers.csv').trimEnd().split('\r\n')).toHaveLength(1 + 24);
    for (const name of Object.keys(files)) expect(strFromU8(files[name] as Uint8Array)).not.toContain('P02');
  });

  test('of what a participant typed runs nothing in a spreadsheet', () => {
    const { store } = withPaperStudy();
    const records = completed().map((record) =>
      record.kind === 'demographics' ? { ...record, body: { ...record.body, major: '=cmd|calc' } } : record,
    );
    store.storeRecords('paper', 'P01', records, now);
    const files = unzipSync(exportZip(contentOf(store, 'P01'), 'P01'));
    expect(strFromU8(files['paper-P01/participants.csv'] as Uint8Array)).toContain(",'=cmd|calc,");
  });

  test('of simulated people says so in its name, its text and every row', () => {
    const { store } = withPaperStudy({ simulated: true });
    store.storeRecords('paper', 'P01', completed('P01', { simulated: true }), now);
    const files = unzipSync(exportZip(contentOf(store)));
    expect(Object.keys(files).every((name) => name.startsWith('SIMULATED-paper/'))).toBe(true);
    expect(strFromU8(files['SIMULATED-paper/README.txt'] as Uint8Array)).toMatch(/^SIMULATED/);
    const [, ...rows] = strFromU8(files['SIMULATED-paper/trials.csv'] as Uint8Array)
      .trimEnd()
      .split('\r\n');
    for (const row of rows) expect(row).toMatch(/^paper,P01,TRUE,/);
  });

  test('after deletion is empty, and works', () => {
    const { store } = withPaperStudy();
    store.storeRecords('paper', 'P01', completed('P01'), now);
    const before = unzipSync(exportZip(contentOf(store, 'P01'), 'P01'));
    store.deleteParticipant('paper', 'P01', 'experimenter', now);
    const after = unzipSync(exportZip(contentOf(store, 'P01'), 'P01'));
    expect(Object.keys(after)).toEqual(Object.keys(before));
    expect(JSON.parse(strFromU8(after['paper-P01/records.json'] as Uint8Array)).records).toEqual([]);
  });
});

describe('a server killed while it writes (kill -9)', () => {
  /** Lets the writer live for some acknowledgements and then kills it; what it acknowledged. */
  const acknowledgedBefore = (file: string, first: number, acknowledgements: number) =>
    new Promise<string[]>((resolve, reject) => {
      const writer = spawn(
        process.execPath,
        ['--import', 'tsx', join(root, 'tests/server/study-writer.ts'), file, String(first)],
        { cwd: root, stdio: ['ignore', 'pipe', 'pipe'] },
      );
      let said = '';
      let complaint = '';
      writer.stderr.on('data', (chunk) => {
        complaint += chunk;
      });
      writer.stdout.on('data', (chunk) => {
        said += chunk;
        if (said.split('\n').length > acknowledgements) writer.kill('SIGKILL');
      });
      writer.on('close', (_, signal) => {
        if (signal !== 'SIGKILL') reject(new Error(`the writer ended by itself: ${complaint}`));
        // The last line may be cut off.
        else resolve(said.split('\n').slice(0, -1));
      });
    });

  test('loses nothing that was acknowledged, and no half of a batch remains', { tags: ['full'] }, async () => {
    const { store, file } = withPaperStudy();
    store.storeRecords('paper', 'P01', completed().slice(0, 1), now);
    store.close();
    const acknowledged: string[] = [];
    for (const [round, count] of [1, 7, 40, 150].entries()) {
      acknowledged.push(...(await acknowledgedBefore(file, 1_000_000 * (round + 1), count)));
      const { store: survivor } = opened(file);
      const stored = new Set(survivor.records('paper', 'P01').map(({ id }) => id));
      for (const id of acknowledged) expect(stored.has(id), id).toBe(true);
      const firstHalves = [...stored].filter((id) => id.endsWith('-a'));
      expect(firstHalves.length).toBeGreaterThan(0);
      for (const id of firstHalves) expect(stored.has(id.replace(/a$/, 'b')), id).toBe(true);
      survivor.close();
      const database = new DatabaseSync(file);
      expect(database.prepare('PRAGMA integrity_check').get()).toMatchObject({ integrity_check: 'ok' });
      database.close();
    }
    expect(acknowledged.length).toBeGreaterThanOrEqual(1 + 7 + 40 + 150);
  });
});
