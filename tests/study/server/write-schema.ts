// node --import tsx tests/study/server/write-schema.ts: writes a database of the current schema, and what is
// in it, into tests/golden. Later versions of the program must open it (tests/study/server/released-schemas.test.ts).
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { DatabaseSync } from '@photostructure/sqlite';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { checkedRecord } from '../../../src/study/model/records/study-record';
import { openStudyStore } from '../../../src/study/server/sqlite/study-store';
import { latencyPlan, session } from '../model/studies';

const now = 1_800_000_000;
const directory = mkdtempSync(join(tmpdir(), 'threepoint-schema-'));
const file = join(directory, 'studies.db');
const store = openStudyStore(file);
const plan = latencyPlan();
const software = { name: 'threepoint', version: '0.1.0', weights: [] };
store.software.note(software, now);
store.plans.add(plan, { simulated: false, at: now });
const { token, withdrawalCode } = store.places.claim('latency', 'P02', now);
const p02 = session(scheduleFor(plan, 'P02'));
p02.doUntil(({ kind }) => kind === 'trial');
// The server stores a record as its check returns it.
const records = p02.records.map((record) => checkedRecord(JSON.parse(JSON.stringify(record)), plan));
store.records.store('latency', 'P02', records, now);
store.places.saveProgress('latency', 'P02', p02.progress, now);
const command = { type: 'pause' } as const;
store.commands.add('latency', 'P02', command, now);
const receipt = store.deletion.delete('latency', 'P03', 'withdrawn', now);
const later = latencyPlan({ title: 'A body that follows much later' });
store.plans.add(later, { simulated: false, newVersion: true, at: now });
const [first] = store.overview('latency', now);
store.close();
const database = new DatabaseSync(file);
const { user_version: schema } = database.prepare('PRAGMA user_version').get() as { user_version: number };
database.close();

const golden = (ending: string) =>
  fileURLToPath(new URL(`../../golden/studies-schema-${schema}.${ending}`, import.meta.url));
writeFileSync(golden('db.gz'), gzipSync(readFileSync(file), { level: 9 }));
const content = {
  ...{ now, token, withdrawalCode, command, receipt, software, invitation: first?.invitation },
  ...{ titles: [plan.title, later.title], records, progress: p02.progress },
};
writeFileSync(golden('json'), `${JSON.stringify(content)}\n`);
rmSync(directory, { recursive: true });
console.log(`tests/golden/studies-schema-${schema}.db.gz has schema ${schema}.`);
