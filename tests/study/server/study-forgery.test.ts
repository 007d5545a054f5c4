import { strFromU8, unzipSync } from 'fflate';
import { describe, expect, test } from 'vitest';
import { csvRows } from '../../../src/study/cli/verify/csv-rows';
import type { StudyRecord } from '../../../src/study/model/records/study-record';
import { completed } from '../model/studies';
import { experimenter, now, servedPaperStudy } from './running-studies';

const own = (rest: string) => `/api/studies/paper/participants/P01/${rest}`;

/** P01 with the records of a whole session, of which only the consent is sent; the clocks of page and server agree. */
async function participant() {
  const server = await servedPaperStudy();
  const token = await server.claim('P01');
  const records: StudyRecord[] = completed().map((record) => ({ ...record, at: now }));
  const send = (sent: readonly unknown[], as = token) =>
    server.ask('POST', own('records'), { token: as, json: { records: sent } });
  expect((await send(records.slice(0, 1))).status).toBe(200);
  return { ...server, token, records, send };
}

const ofKind = (records: readonly StudyRecord[], kind: StudyRecord['kind'], found = (_: StudyRecord) => true) =>
  records.find((record) => record.kind === kind && found(record)) as StudyRecord;

/** Returns a copy of a record with other fields in its body. */
const changed = (record: StudyRecord, body: object) => ({ ...record, body: { ...record.body, ...body } });

const event = (id: string, body: object) => ({
  ...{ version: 1, id, study: 'paper', participant: 'P01', simulated: false, at: now },
  ...{ kind: 'event', body },
});

const block = { task: 'archery', block: 1, run: 1 };
const voided = event('event-1', { type: 'void-block', ...block, reason: 'fire alarm', repeat: true });
const place = { ...block, attempt: 1 };
const stopped = event('event-2', {
  ...{ type: 'stop', by: 'experimenter', reason: 'fire alarm', place, step: 'archery/1/rest' },
});

describe('the server refuses from a participant', () => {
  test.each([
    ['a voided block', voided],
    ['a stop by the experimenter', stopped],
  ])('%s that the experimenter did not send, and takes it once where they did', async (_, record) => {
    const { ask, send, store } = await participant();
    const refused = await send([record]);
    expect([refused.status, store.records.all('paper')]).toEqual([403, expect.toSatisfy((all) => all.length === 1)]);
    expect(refused.json.error).toContain('no command of the experimenter');
    const { type, by, reason, repeat } = record.body as Record<string, unknown>;
    const command =
      type === 'stop' ? { type, by, reason } : { type, reason, repeat, of: { task: 'archery', block: 1 } };
    const given = await ask('POST', own('commands'), { token: experimenter, json: command });
    expect(given.status).toBe(201);
    expect((await send([changed(record as never, { reason: 'another' })])).status).toBe(403);
    expect((await send([record])).status).toBe(200);
    expect((await send([record])).status, 'the same once more').toBe(200);
    expect((await send([{ ...record, id: 'event-9' }])).status).toBe(403);
  });

  test.each([
    ['trial', { condition: 'paper-2' }, 'body.condition'],
    ['trial', { group: 7 }, 'body.group'],
    ['trial', { estimator: 'device' }, 'body.estimator'],
    ['trial', { repetition: 9 }, 'body.repetition'],
    ['trial', { place: { ...place, block: 9 } }, 'body.place'],
    ['trial', { place: { ...place, task: 'ball-2' } }, 'body.place'],
    ['answers', { condition: 'paper-2' }, 'body.condition'],
    ['answers', { estimator: 'hands-only' }, 'body.estimator'],
    ['calibration', { place: { ...place, block: 9 } }, 'body.place'],
  ] as const)('a record of kind %s with %j, which the plan lacks', async (kind, body, field) => {
    const { records, send, store } = await participant();
    const record = ofKind(
      records,
      kind,
      (one) => kind !== 'trial' || (one.body as { condition: unknown }).condition !== null,
    );
    const { status, json } = await send([changed(record, body)]);
    expect([status, json.field?.startsWith(`records[0].${field}`)], json.error).toEqual([400, true]);
    expect(store.records.all('paper')).toHaveLength(1);
    expect((await send([record])).status).toBe(200);
  });

  test('answers to a questionnaire that the block does not ask', async () => {
    const { records, send } = await participant();
    const ball = ofKind(records, 'answers', ({ body }) => 'questionnaire' in body && body.questionnaire === 'ball');
    expect((await send([changed(ball, { place })])).json.field).toBe('records[0].body.questionnaire');
    expect((await send([ball])).status).toBe(200);
  });

  test('an event of a step or block that the plan lacks', async () => {
    const { send } = await participant();
    const of = (step: string, block: number) =>
      send([event('event-1', { type: 'interrupted', place: { ...place, block }, step })]);
    expect((await of('archery/9/trial-1', 1)).json.field).toBe('records[0].body.step');
    expect((await of('archery/1/trial-1', 9)).json.field).toBe('records[0].body.place');
    expect((await of('archery/1/trial-1', 1)).status).toBe(200);
  });

  test('a score above the maximum', async () => {
    const { records, send } = await participant();
    const trial = ofKind(records, 'trial') as Extract<StudyRecord, { kind: 'trial' }>;
    const outcome = { ...trial.body.outcome, score: 100_000, maximum: 1 };
    const { status, json } = await send([changed(trial, { outcome })]);
    expect([status, json.field]).toEqual([400, 'records[0].body.outcome.score']);
  });

  test('a recording of a trial that the plan lacks', async () => {
    const { ask, token } = await participant();
    const { status, json } = await ask('PUT', `${own('motion')}?trial=archery/9/trial-1@1.1:trial`, {
      token,
      json: {},
    });
    expect([status, json.field]).toEqual([400, 'trial']);
  });
});

describe('an export', () => {
  async function tableOf(server: Awaited<ReturnType<typeof participant>>, name: string) {
    const { body } = await server.ask('GET', own('export'), { token: experimenter });
    const [heads = [], ...rows] = csvRows(strFromU8(unzipSync(body)[`paper-P01/${name}.csv`] as Uint8Array));
    return rows.map((row) => Object.fromEntries(heads.map((head, column) => [head, row[column]])));
  }

  test('states in each row the token that it came with, whatever the record claims', { tags: ['full'] }, async () => {
    const server = await participant();
    const { ask, records, send } = server;
    const [, ...others] = records;
    expect((await send(others.map((record) => ({ ...record, author: 'experimenter' })))).status).toBe(200);
    await send([event('event-70', { type: 'remark', text: 'of the participant' })]);
    await ask('POST', own('remarks'), { token: experimenter, json: { text: 'of the experimenter' } });
    for (const name of ['participants', 'answers', 'scales', 'trials', 'frame-times', 'hits', 'pauses', 'events']) {
      const rows = await tableOf(server, name);
      const authorOf = (text?: string) => (text === 'of the experimenter' ? 'experimenter' : 'participant');
      const wrong = rows.filter(({ author, text }) => author !== authorOf(text));
      expect(wrong, name).toEqual([]);
    }
    const { records: kept } = (await ask('GET', own('records'), { token: experimenter })).json;
    expect(kept.at(-1)).toMatchObject({ author: 'experimenter', receivedAt: now });
  });

  test('flags faults of a wrong clock or an older device state, and nothing else', async () => {
    const server = await participant();
    const { records, send } = server;
    const [, ...others] = records;
    await send(others);
    expect((await tableOf(server, 'trials')).map(({ flag }) => flag).filter(Boolean)).toEqual([]);
    const trial = ofKind(records, 'trial', ({ body }) => (body as { condition: unknown }).condition !== null);
    const again = { ...trial, id: 'again', at: 1e11 };
    const later = changed({ ...trial, id: 'run-3', at: 1 }, { place: { ...place, run: 3 } });
    expect((await send([again, later])).status).toBe(200);
    const flags = (await tableOf(server, 'trials')).map(({ flag }) => flag).filter(Boolean);
    expect(flags).toEqual(['clock; repeated', 'clock; run']);
  });
});
