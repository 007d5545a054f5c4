import { strFromU8, unzipSync } from 'fflate';
import { describe, expect, test } from 'vitest';
import { exportZip } from '../../../../src/study/server/export/export-zip';
import type { StudyStore } from '../../../../src/study/server/sqlite/study-store';
import { unpacked } from '../../../../src/study/server/study-storage';
import { completed } from '../../model/studies';
import { now, testSoftware } from '../running-studies';
import { withPaperStudy } from '../stored-studies';

describe('an export', () => {
  const contentOf = (store: StudyStore, participant?: string) => {
    const { plan, simulated, retentionUntil } = store.plans.get('paper');
    const records = store.records.all('paper', participant);
    const motion = store.motion.all('paper', participant).map(unpacked);
    return { plan, simulated, records, motion, at: now, retentionUntil, software: testSoftware };
  };

  test('holds JSON, tidy tables and a codebook, of this participant alone', () => {
    const { store } = withPaperStudy();
    for (const participant of ['P01', 'P02']) store.records.store('paper', participant, completed(participant), now);
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
    expect(JSON.parse(read('records.json')).records).toEqual(store.records.all('paper', 'P01'));
    expect(read('answers.csv').trimEnd().split('\r\n')).toHaveLength(1 + 24);
    for (const name of Object.keys(files)) expect(strFromU8(files[name] as Uint8Array)).not.toContain('P02');
  });

  test('runs nothing that a participant typed in a spreadsheet', () => {
    const { store } = withPaperStudy();
    const records = completed().map((record) =>
      record.kind === 'demographics' ? { ...record, body: { ...record.body, major: '=cmd|calc' } } : record,
    );
    store.records.store('paper', 'P01', records, now);
    const files = unzipSync(exportZip(contentOf(store, 'P01'), 'P01'));
    expect(strFromU8(files['paper-P01/participants.csv'] as Uint8Array)).toContain(",'=cmd|calc,");
  });

  test('names its simulated people in its name, its text and every row', () => {
    const { store } = withPaperStudy({ simulated: true });
    store.records.store('paper', 'P01', completed('P01', { simulated: true }), now);
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
    store.records.store('paper', 'P01', completed('P01'), now);
    const before = unzipSync(exportZip(contentOf(store, 'P01'), 'P01'));
    store.deletion.delete('paper', 'P01', 'experimenter', now);
    const after = unzipSync(exportZip(contentOf(store, 'P01'), 'P01'));
    expect(Object.keys(after)).toEqual(Object.keys(before));
    expect(JSON.parse(strFromU8(after['paper-P01/records.json'] as Uint8Array)).records).toEqual([]);
  });
});
