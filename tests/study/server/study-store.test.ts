import { copyFileSync } from 'node:fs';
import { join } from 'node:path';
import { DatabaseSync } from '@photostructure/sqlite';
import { describe, expect, test } from 'vitest';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { begin, reported } from '../../../src/study/model/progress/progress';
import type { StudyRecord } from '../../../src/study/model/records/study-record';
import { directoryWith } from '../../temporary-directory';
import { completed, paperPlan, session } from '../model/studies';
import { now } from './running-studies';
import { asSent, opened, withPaperStudy } from './stored-studies';

describe('the store', () => {
  test('gives back what it was given, after being closed and opened', () => {
    const { store, file } = withPaperStudy();
    const records = completed();
    expect(store.records.store('paper', 'P01', records, now)).toEqual(records.map(({ id }) => id));
    store.close();
    expect(opened(file).store.records.all('paper', 'P01').map(asSent)).toEqual(records);
  });

  test('keeps its log beside it (WAL)', () => {
    const { file } = withPaperStudy();
    expect(new DatabaseSync(file).prepare('PRAGMA journal_mode').get()).toMatchObject({ journal_mode: 'wal' });
  });

  test('once closed, is whole in the one file: a copy of it alone has everything', () => {
    const { store, file } = withPaperStudy();
    const records = completed();
    store.records.store('paper', 'P01', records, now);
    store.close();
    const copy = join(directoryWith(), 'copy.db');
    copyFileSync(file, copy);
    expect(opened(copy).store.records.all('paper', 'P01').map(asSent)).toEqual(records);
  });

  test('stores once what is sent twice, and says so both times', () => {
    const { store } = withPaperStudy();
    const records = completed();
    store.records.store('paper', 'P01', records, now);
    expect(store.records.store('paper', 'P01', records, now + 5)).toHaveLength(records.length);
    expect(store.records.all('paper')).toHaveLength(records.length);
  });

  test('does not overwrite what it has', () => {
    const { store } = withPaperStudy();
    const records = completed();
    store.records.store('paper', 'P01', records, now);
    const changed = { ...(records[1] as StudyRecord), at: 7 };
    expect(() => store.records.store('paper', 'P01', [changed], now)).toThrow('has stored something else');
    expect(store.records.all('paper', 'P01').map(asSent)[1]).toEqual(records[1]);
  });

  test('stores a batch whole or not at all', () => {
    const { store } = withPaperStudy();
    const records = completed();
    const foreign = { ...(records.at(-1) as StudyRecord), participant: 'P02' };
    expect(() => store.records.store('paper', 'P01', [...records.slice(0, -1), foreign], now)).toThrow('is of P02');
    expect(store.records.all('paper')).toEqual([]);
  });

  test('stores nothing before consent, and takes consent to the shown text alone', () => {
    const { store } = withPaperStudy();
    const [consent, ...rest] = completed() as [StudyRecord, ...StudyRecord[]];
    expect(() => store.records.store('paper', 'P01', rest, now)).toThrow('has not consented');
    expect(() => store.records.addRemark('paper', 'P01', 'tall', now)).toThrow('has not consented');
    const old = { ...consent, body: { ...consent.body, version: '2001' } } as StudyRecord;
    expect(() => store.records.store('paper', 'P01', [old], now)).toThrow('consent is to text 2001');
    store.records.store('paper', 'P01', [consent, ...rest], now);
  });

  test('keeps simulated people and people apart', () => {
    const people = withPaperStudy().store;
    expect(() => people.records.store('paper', 'P01', completed('P01', { simulated: true }), now)).toThrow('of people');
    expect(() => people.plans.add(paperPlan(), { simulated: true, at: now })).toThrow('give this one another id');
    const simulated = withPaperStudy({ simulated: true }).store;
    expect(() => simulated.records.store('paper', 'P01', completed(), now)).toThrow('is simulated');
  });

  test('knows where each participant is', () => {
    const { store } = withPaperStudy();
    store.places.claim('paper', 'P02', now);
    store.records.store('paper', 'P02', completed('P02').slice(0, 1), now);
    store.places.saveProgress('paper', 'P02', { ...begin(scheduleFor(paperPlan(), 'P02')), step: 'consent' }, now);
    const [first, second] = store.overview('paper', now + 20);
    expect(first).toMatchObject({ participant: 'P01', claimed: false, session: null });
    expect(second).toMatchObject({ participant: 'P02', claimed: true, session: { step: 'consent', silence: 20 } });
    expect(store.places.progress('paper', 'P02')?.step).toBe('consent');
  });

  test('counts the time of a step by its own clock, whatever the device’s says', () => {
    const { store } = withPaperStudy();
    store.places.claim('paper', 'P01', now);
    const one = session(scheduleFor(paperPlan(), 'P01'));
    one.doUntil(({ kind }) => kind === 'rest');
    store.records.store('paper', 'P01', one.records, now);
    one.wait(20);
    // The device's clock is an hour ahead of the server's.
    store.places.saveProgress('paper', 'P01', reported(one.progress, one.now), one.now - 3600);
    const [state] = store.overview('paper', one.now - 3600 + 15);
    expect(state?.session?.remainingSeconds).toBeCloseTo(25, 6);
    expect(store.places.progress('paper', 'P01', one.now - 3600 + 15)?.elapsed).toBeCloseTo(35, 6);
    expect(store.places.progress('paper', 'P01')?.elapsed).toBeCloseTo(20, 6);
  });

  test('still opens progress with the start of the device’s clock, as older pages stored', () => {
    const { store } = withPaperStudy();
    const one = session(scheduleFor(paperPlan(), 'P01'));
    one.doUntil(({ kind }) => kind === 'rest');
    store.records.store('paper', 'P01', one.records, now);
    store.places.saveProgress('paper', 'P01', one.progress, one.now);
    expect(store.overview('paper', one.now + 15)[0]?.session?.remainingSeconds).toBeCloseTo(45, 6);
    expect(store.places.progress('paper', 'P01', one.now + 15)).toEqual(one.progress);
  });

  test('hands on commands in order, each once', () => {
    const { store } = withPaperStudy();
    const first = store.commands.add('paper', 'P01', { type: 'pause' }, now);
    store.commands.add('paper', 'P02', { type: 'start' }, now);
    store.commands.add('paper', 'P01', { type: 'resume' }, now);
    expect(store.commands.after('paper', 'P01', 0).map(({ command }) => command.type)).toEqual(['pause', 'resume']);
    expect(store.commands.after('paper', 'P01', first).map(({ command }) => command.type)).toEqual(['resume']);
  });
});
