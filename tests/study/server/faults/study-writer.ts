// Stores one record after the other for as long as it lives and says which were acknowledged, one id per line.
// node --import tsx tests/study/server/faults/study-writer.ts DATABASE FIRST
import { writeSync } from 'node:fs';
import { recordVersion, type StudyRecord } from '../../../../src/study/model/records/study-record';
import { openStudyStore } from '../../../../src/study/server/sqlite/study-store';

const [file, first] = process.argv.slice(2) as [string, string];
const store = openStudyStore(file);
const base = { version: recordVersion, study: 'paper', participant: 'P01', simulated: false } as const;

for (let number = Number(first); ; number++) {
  // Two at a time: all or nothing.
  const records = ['a', 'b'].map((part): StudyRecord => {
    const id = `event-${number}-${part}`;
    return { ...base, id, at: number, kind: 'event', body: { type: 'remark', text: 'x'.repeat(500) } };
  });
  const acknowledged = store.records.store('paper', 'P01', records, number);
  await store.flushed();
  writeSync(1, `${acknowledged.join('\n')}\n`);
}
