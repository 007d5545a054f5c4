import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gunzipSync } from 'node:zlib';
import { DatabaseSync } from '@photostructure/sqlite';
import { describe, expect, test } from 'vitest';
import { openStudyStore } from '../../../src/study/server/sqlite/study-store';
import { directoryWith } from '../../temporary-directory';
import { type Anything, servedStudies } from './running-studies';
import { asSent } from './stored-studies';

const golden = new URL('../../golden/', import.meta.url);
const schemas = readdirSync(golden).flatMap((file) => /^studies-schema-(\d+)\.json$/.exec(file)?.slice(1, 2) ?? []);

/** Returns the schema's number and definitions in a database. */
function schemaOf(file: string) {
  const database = new DatabaseSync(file);
  const definitions = database.prepare('SELECT type, name, sql FROM sqlite_master ORDER BY type, name').all();
  const { user_version: number } = database.prepare('PRAGMA user_version').get() as { user_version: number };
  const faults = database.prepare('PRAGMA foreign_key_check').all();
  database.close();
  return { number, definitions, faults };
}

function currentSchema() {
  const file = join(directoryWith(), 'studies.db');
  openStudyStore(file).close();
  return schemaOf(file);
}

test('the current schema has a file, which every later version must open', () => {
  const command = 'node --import tsx tests/study/server/write-schema.ts';
  expect(schemas, `run ${command}`).toContain(String(currentSchema().number));
});

describe.each(schemas)('a database of schema %s', (schema) => {
  const content: Anything = JSON.parse(readFileSync(new URL(`studies-schema-${schema}.json`, golden), 'utf8'));
  function unpackedFile(): string {
    const file = join(directoryWith(), 'studies.db');
    writeFileSync(file, gunzipSync(readFileSync(new URL(`studies-schema-${schema}.db.gz`, golden))));
    return file;
  }

  test('becomes one of the current schema, as a new one is', () => {
    const file = unpackedFile();
    expect(schemaOf(file).number).toBe(Number(schema));
    openStudyStore(file).close();
    expect(schemaOf(file)).toEqual({ ...currentSchema(), faults: [] });
  });

  test('loses nothing', async () => {
    const { ask, store } = await servedStudies({ file: unpackedFile() });
    const { now, token, records, progress, command, receipt, invitation, titles } = content;
    expect(store.records.all('latency').map(asSent)).toEqual(records);
    for (const { author } of store.records.all('latency')) expect(author).toBe('participant');
    expect(store.places.holds('latency', 'P02', token)).toBe(true);
    expect(store.places.acceptsInvitation('latency', 'P01', invitation)).toBe(true);
    expect(store.places.progress('latency', 'P02')).toEqual(progress);
    expect(store.commands.after('latency', 'P02', 0)).toMatchObject([{ command }]);
    expect(store.deletion.receipts('latency')).toMatchObject([receipt]);
    expect([store.plans.planFor('latency', 'P02').title, store.plans.get('latency').plan.title]).toEqual(titles);
    expect(store.software.since(now)).toMatchObject([content.software]);
    const place = '/api/studies/latency/participants/P02';
    expect((await ask('POST', `${place}/records`, { token, json: { records } })).status).toBe(200);
    expect(store.deletion.withdraw('latency', content.withdrawalCode, now)).toMatchObject({ participant: 'P02' });
  });
});
