import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, expect, test } from 'vitest';
import { normalisedCode } from '../../../src/study/server/storage/schema';
import { completed } from '../model/studies';
import { now } from './running-studies';
import { withPaperStudy } from './stored-studies';

const day = 86_400;

describe('the deletion of a participant', () => {
  const bytesOf = (file: string) => {
    const folder = join(file, '..');
    return readdirSync(folder)
      .map((name) => readFileSync(join(folder, name)).toString('latin1'))
      .join();
  };

  test('leaves a receipt and no trace in the file', () => {
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

  test('concerns one participant alone', () => {
    const { store } = withPaperStudy();
    for (const participant of ['P01', 'P02']) {
      store.records.store('paper', participant, completed(participant), now);
    }
    store.deletion.delete('paper', 'P01', 'experimenter', now);
    expect(store.records.all('paper').every(({ participant }) => participant === 'P02')).toBe(true);
    expect(store.records.all('paper')).toHaveLength(completed('P02').length);
  });

  test('takes the withdrawal code, however it is typed, and is for good', () => {
    const { store } = withPaperStudy();
    const { withdrawalCode } = store.places.claim('paper', 'P01', now);
    store.records.store('paper', 'P01', completed(), now);
    expect(store.deletion.withdraw('paper', '0000-0000-0000-0000', now)).toBeNull();
    const typed = (withdrawalCode as string).toLowerCase().replaceAll('-', ' ');
    expect(store.deletion.withdraw('paper', typed, now)).toMatchObject({ participant: 'P01', reason: 'withdrawn' });
    expect(() => store.places.claim('paper', 'P01', now)).toThrow('has withdrawn');
    expect(() => store.records.store('paper', 'P01', completed(), now)).toThrow('has withdrawn');
    expect(store.deletion.withdraw('paper', withdrawalCode as string, now)).toBeNull();
  });

  test('takes o for 0 and l for 1 in a code, since they look alike', () => {
    expect(normalisedCode('o1lI 23ab-cdef-ghjk')).toBe('0111-23AB-CDEF-GHJK');
  });

  test('happens by itself after the retention date, not before', () => {
    const { store } = withPaperStudy();
    store.places.claim('paper', 'P01', now);
    store.records.store('paper', 'P01', completed(), now);
    const expired = (at: number) => store.deletion.deleteExpired(at, (_, error) => expect(error).toBeNull());
    expect(expired(now + 365 * day)).toEqual([]);
    expect(expired(now + 365 * day + 1)).toMatchObject([{ participant: 'P01', reason: 'retention' }]);
    expect(store.records.all('paper')).toEqual([]);
    expect(expired(now + 366 * day)).toEqual([]);
  });
});
