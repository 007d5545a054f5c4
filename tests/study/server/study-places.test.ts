import { readFileSync } from 'node:fs';
import { describe, expect, test } from 'vitest';
import { completed } from '../model/studies';
import { now } from './running-studies';
import { withPaperStudy } from './stored-studies';

describe('a place in the study', () => {
  test('belongs to the first device that claims it', () => {
    const { store } = withPaperStudy();
    const { token } = store.places.claim('paper', 'P01', now);
    expect(() => store.places.claim('paper', 'P01', now)).toThrow('taken by another device');
    expect(store.places.holds('paper', 'P01', token)).toBe(true);
    expect(store.places.holds('paper', 'P02', token)).toBe(false);
    expect(store.places.holds('paper', 'P01', `${token}x`)).toBe(false);
  });

  test('goes to the next device after its release; the withdrawal code stays', () => {
    const { store } = withPaperStudy();
    const first = store.places.claim('paper', 'P01', now);
    store.records.store('paper', 'P01', completed(), now);
    store.places.release('paper', 'P01');
    const second = store.places.claim('paper', 'P01', now);
    expect(store.places.holds('paper', 'P01', first.token)).toBe(false);
    expect(store.places.holds('paper', 'P01', second.token)).toBe(true);
    expect(second.withdrawalCode).toBeNull();
    expect(store.deletion.withdraw('paper', first.withdrawalCode as string, now)?.participant).toBe('P01');
  });

  test('gives its withdrawal code again while it has no record, as the answer may be lost', () => {
    const { store } = withPaperStudy();
    const lost = store.places.claim('paper', 'P01', now).withdrawalCode as string;
    store.places.release('paper', 'P01');
    const { withdrawalCode } = store.places.claim('paper', 'P01', now);
    expect(withdrawalCode).toMatch(/^(\w{4}-){3}\w{4}$/);
    expect(withdrawalCode).not.toBe(lost);
    store.records.store('paper', 'P01', completed(), now);
    expect(store.deletion.withdraw('paper', lost, now)).toBeNull();
    expect(store.deletion.withdraw('paper', withdrawalCode as string, now)?.participant).toBe('P01');
  });

  test('keeps neither token nor code, only what proves them', () => {
    const { store, file } = withPaperStudy();
    const { token, withdrawalCode } = store.places.claim('paper', 'P01', now);
    store.close();
    const bytes = readFileSync(file).toString('latin1');
    expect(bytes).not.toContain(token);
    expect(bytes).not.toContain(withdrawalCode as string);
  });
});
