import { copyFileSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { DatabaseSync } from '@photostructure/sqlite';
import { describe, expect, onTestFinished, test } from 'vitest';
import { directoryWith } from '../../temporary-directory';
import { completed } from '../model/studies';
import { now } from './running-studies';
import { asSent, opened, withPaperStudy } from './stored-studies';

describe('a file of SQLite', () => {
  const bytesOf = (file: string) => {
    const folder = join(file, '..');
    return readdirSync(folder)
      .map((name) => readFileSync(join(folder, name)).toString('latin1'))
      .join();
  };

  test('has its log beside it (WAL)', () => {
    const { file } = withPaperStudy();
    expect(new DatabaseSync(file).prepare('PRAGMA journal_mode').get()).toMatchObject({ journal_mode: 'wal' });
  });

  test('once closed, is whole in the one file: a copy of it alone has everything', () => {
    const { store, file } = withPaperStudy();
    const records = completed();
    expect(store.records.store('paper', 'P01', records, now)).toEqual(records.map(({ id }) => id));
    store.close();
    const copy = join(directoryWith(), 'copy.db');
    copyFileSync(file, copy);
    expect(opened(copy).store.records.all('paper', 'P01').map(asSent)).toEqual(records);
  });

  test('keeps neither token nor withdrawal code, only what proves them', () => {
    const { store, file } = withPaperStudy();
    const { token, withdrawalCode } = store.places.claim('paper', 'P01', now);
    store.close();
    const bytes = readFileSync(file).toString('latin1');
    expect(bytes).not.toContain(token);
    expect(bytes).not.toContain(withdrawalCode as string);
  });

  test('has no trace of a deleted participant, apart from the receipt', () => {
    const { store, file } = withPaperStudy();
    store.places.claim('paper', 'P01', now);
    const records = completed();
    store.records.store('paper', 'P01', records, now);
    store.records.addRemark('paper', 'P01', 'wore a conspicuous hat', now);
    expect(bytesOf(file)).toContain('conspicuous hat');
    const receipt = store.deletion.delete('paper', 'P01', 'experimenter', now + 9);
    expect(receipt).toEqual({
      number: 1,
      study: 'paper',
      participant: 'P01',
      reason: 'experimenter',
      records: records.length + 1,
      motionFiles: 0,
      at: now + 9,
    });
    expect(store.records.all('paper')).toEqual([]);
    expect(store.deletion.receipts('paper')).toEqual([receipt]);
    expect(bytesOf(file)).not.toContain('conspicuous hat');
    expect(bytesOf(file)).not.toContain('Computer science');
  });

  test('has bytes of a deleted participant in its log only while another program reads it', () => {
    const { store, file } = withPaperStudy();
    const { withdrawalCode } = store.places.claim('paper', 'P01', now);
    store.records.store('paper', 'P01', completed(), now);
    store.records.addRemark('paper', 'P01', 'wore a conspicuous hat', now);
    const reader = new DatabaseSync(file);
    onTestFinished(() => reader.close());
    reader.exec('BEGIN; SELECT count(*) FROM records');
    store.deletion.withdraw('paper', withdrawalCode as string, now);
    expect(store.purgeDeleted()).toBe(false);
    expect(bytesOf(file)).toContain('conspicuous hat');
    reader.exec('COMMIT');
    expect(store.purgeDeleted()).toBe(true);
    expect(bytesOf(file)).not.toContain('conspicuous hat');
    store.close();
    expect(bytesOf(file)).not.toContain('conspicuous hat');
  });
});
