import { strFromU8, unzipSync } from 'fflate';
import { describe, expect, test } from 'vitest';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { bodyLimits } from '../../../src/study/server/routes/route';
import { reportFigures } from '../../reliability/report-figures';
import { begun, completed, consentAt, paperPlan } from '../model/studies';
import { experimenter, now, servedPaperStudy, servedStudies } from './running-studies';
import { asSent } from './stored-studies';

const own = (participant: string, rest = '') => `/api/studies/paper/participants/${participant}${rest}`;

describe('a participant', () => {
  test('claims a place, sends records, and is told which are safe', async () => {
    const { ask, invited, store } = await servedPaperStudy();
    const claimed = await ask('POST', own('P01', '/claim'), { json: invited('P01') });
    expect(claimed.status).toBe(201);
    expect(claimed.json.withdrawalCode).toMatch(/^(\w{4}-){3}\w{4}$/);
    expect(claimed.json.plan).toEqual(paperPlan());
    const records = completed('P01');
    const sent = await ask('POST', own('P01', '/records'), { token: claimed.json.token, json: { records } });
    expect(sent.json.acknowledged).toEqual(records.map(({ id }) => id));
    expect(store.records.all('paper', 'P01').map(asSent)).toEqual(records);
  });

  test('cannot put records under the code of another', async () => {
    const { ask, claim, store } = await servedPaperStudy();
    const token = await claim('P01');
    const answer = await ask('POST', own('P01', '/records'), { token, json: { records: completed('P02') } });
    expect(answer.status).toBe(403);
    expect(store.records.all('paper')).toEqual([]);
  });

  test('learns nothing of the conditions before the place is theirs', async () => {
    const { ask } = await servedPaperStudy();
    const { json } = await ask('GET', '/api/studies/paper');
    expect(Object.keys(json).toSorted()).toEqual([
      'consent',
      'contact',
      'id',
      'languages',
      'phrases',
      'simulated',
      'title',
    ]);
  });

  test('withdraws with the code alone, and gets a receipt', async () => {
    const { ask, invited, store } = await servedPaperStudy();
    const { token, withdrawalCode } = (await ask('POST', own('P01', '/claim'), { json: invited('P01') })).json;
    await ask('POST', own('P01', '/records'), { token, json: { records: completed('P01') } });
    expect((await ask('POST', '/api/studies/paper/withdraw', { json: { code: 'AAAA-AAAA-AAAA-AAAA' } })).status).toBe(
      404,
    );
    const { json } = await ask('POST', '/api/studies/paper/withdraw', { json: { code: withdrawalCode } });
    expect(json).toMatchObject({ participant: 'P01', reason: 'withdrawn', records: completed('P01').length });
    expect(store.records.all('paper')).toEqual([]);
    expect((await ask('POST', own('P01', '/records'), { token, json: { records: completed('P01') } })).status).toBe(
      401,
    );
  });

  test('gets no seat in a match that the group has finished', async () => {
    const { ask, claim, store } = await servedPaperStudy();
    const [first, second] = (scheduleFor(paperPlan(), 'P01').groups.ball?.members ?? []) as [string, string];
    const tokens = new Map<string, string>();
    const reportAt = async (participant: string, step: string, more: object = {}) => {
      const progress = { ...begun(paperPlan(), participant), motion: false, step, ...more };
      const sent = { token: tokens.get(participant) ?? '', json: progress };
      expect((await ask('PUT', own(participant, '/progress'), sent)).status).toBe(204);
    };
    for (const participant of [first, second]) {
      tokens.set(participant, await claim(participant));
      store.records.store('paper', participant, [consentAt(now, participant)], now);
    }
    const seat = () =>
      ask('POST', own(first, '/seat'), { token: tokens.get(first) ?? '', json: { step: 'ball/1/trial-1', run: 1 } });
    await reportAt(second, 'ball/1/trial-1');
    expect((await seat()).status).toBe(200);
    await reportAt(second, 'ball/1/rest');
    const refused = await seat();
    expect(refused.status).toBe(409);
    expect(refused.json).toMatchObject({ field: 'step', error: `${second} has gone on: the match is over` });
    // In another run of the block the match is still to come.
    await reportAt(second, 'ball/1/rest', { runs: { 'ball/1': 2 } });
    expect((await seat()).status).toBe(200);
  });
});

describe('the experimenter', () => {
  test('sees where each participant is and steers', async () => {
    const { ask, claim } = await servedPaperStudy();
    const token = await claim('P01');
    const { json } = await ask('GET', '/api/studies/paper/participants', { token: experimenter });
    expect(json.participants).toHaveLength(15);
    const command = { type: 'void-block', reason: 'controller died', repeat: true };
    const { status, json: sent } = await ask('POST', own('P01', '/commands'), { token: experimenter, json: command });
    expect(status).toBe(201);
    expect((await ask('GET', own('P01', '/commands?after=0'), { token })).json.commands).toEqual([
      { number: sent.number, at: now, command },
    ]);
    expect((await ask('GET', own('P01', `/commands?after=${sent.number}`), { token })).json.commands).toEqual([]);
  });

  test('notes remarks, which are exported', async () => {
    const { ask, claim } = await servedPaperStudy();
    const token = await claim('P01');
    await ask('POST', own('P01', '/records'), { token, json: { records: completed('P01') } });
    expect(
      (await ask('POST', own('P01', '/remarks'), { token: experimenter, json: { text: 'left-handed bow' } })).status,
    ).toBe(201);
    const { body } = await ask('GET', own('P01', '/export'), { token: experimenter });
    expect(strFromU8(unzipSync(body)['paper-P01/events.csv'] as Uint8Array)).toContain('left-handed bow');
  });

  test('exports, deletes, exports', async () => {
    const { ask, claim } = await servedPaperStudy();
    for (const participant of ['P01', 'P02']) {
      const token = await claim(participant);
      await ask('POST', own(participant, '/records'), { token, json: { records: completed(participant) } });
    }
    const rows = async () => {
      const { headers, body } = await ask('GET', '/api/studies/paper/export', { token: experimenter });
      expect(headers.get('content-type')).toBe('application/zip');
      expect(headers.get('content-disposition')).toBe('attachment; filename="paper.zip"');
      return (
        strFromU8(unzipSync(body)['paper/answers.csv'] as Uint8Array)
          .trimEnd()
          .split('\r\n').length - 1
      );
    };
    expect(await rows()).toBe(48);
    const { json } = await ask('DELETE', own('P01'), { token: experimenter });
    expect(json).toMatchObject({ number: 1, participant: 'P01', records: completed('P01').length });
    expect(await rows()).toBe(24);
    expect((await ask('GET', '/api/studies/paper/receipts', { token: experimenter })).json.receipts).toEqual([json]);
  });

  test('exports while others are served', async () => {
    const { ask, store } = await servedPaperStudy();
    for (const participant of ['P01', 'P02', 'P03']) {
      store.records.store('paper', participant, completed(participant), now);
    }
    let ended = false;
    const exported = ask('GET', '/api/studies/paper/export', { token: experimenter }).then((answer) => {
      ended = true;
      return answer;
    });
    for (let requests = 0; requests < 5; requests++) {
      expect((await ask('GET', '/api/studies/paper')).status).toBe(200);
      expect(ended).toBe(false);
    }
    const { status, body } = await exported;
    expect(status).toBe(200);
    expect(Object.keys(unzipSync(body))).toContain('paper/results/scores-compared.csv');
  });

  test('exports for longer than a connection may be silent, several at once', async () => {
    const { ask, store } = await servedPaperStudy({}, { idleTimeoutMs: 1000 });
    const people = ['P01', 'P02'];
    for (const participant of people) store.records.store('paper', participant, completed(participant), now);
    const exported = people.map(async (participant) => {
      const { status, body } = await ask('GET', own(participant, '/export'), { token: experimenter });
      expect(status).toBe(200);
      return JSON.parse(strFromU8(unzipSync(body)[`paper-${participant}/records.json`] as Uint8Array)).records.map(
        asSent,
      );
    });
    expect(await Promise.all(exported)).toEqual(people.map((participant) => completed(participant)));
  });
});

describe('a mistake', () => {
  test('in a plan is named by field', async () => {
    const { ask } = await servedStudies();
    const plan = { ...paperPlan(), seed: -1 };
    const { status, json } = await ask('POST', '/api/studies', {
      token: experimenter,
      json: { plan, simulated: false },
    });
    expect(status).toBe(400);
    expect(json).toEqual({ error: 'seed: expected a whole number from 0 to 2147483647', field: 'seed' });
  });

  test('in a record is named by field, and nothing of the batch is stored', async () => {
    const { ask, claim, store } = await servedPaperStudy();
    const token = await claim('P01');
    const records = completed('P01').map((record) =>
      record.kind === 'demographics' ? { ...record, body: { ...record.body, age: 7 } } : record,
    );
    const { status, json } = await ask('POST', own('P01', '/records'), { token, json: { records } });
    expect(status).toBe(400);
    expect(json.field).toBe('records[1].body.age');
    expect(store.records.all('paper')).toEqual([]);
  });

  test('gets the status that names its kind', async () => {
    const { ask, claim } = await servedPaperStudy();
    const token = await claim('P01');
    const send = async (raw: RequestInit) =>
      (
        await ask('POST', own('P01', '/records'), {
          raw: { ...raw, headers: { authorization: `Bearer ${token}`, ...raw.headers } },
        })
      ).status;
    const asJson = { 'content-type': 'application/json' };
    expect(await send({ body: '{', headers: asJson })).toBe(400);
    expect(await send({ body: '{"records":[]}', headers: asJson })).toBe(400);
    expect(await send({ body: '{}', headers: { 'content-type': 'text/plain' } })).toBe(415);
    expect(await send({ body: `"${'x'.repeat(bodyLimits.json)}"`, headers: asJson })).toBe(413);
    const nested = `${'['.repeat(100_000)}${']'.repeat(100_000)}`;
    const deep = await ask('PUT', own('P01', '/progress'), {
      raw: { body: nested, headers: { ...asJson, authorization: `Bearer ${token}` } },
    });
    expect([deep.status, deep.json.error]).toEqual([400, 'the body is nested more than 64 deep']);
    expect((await ask('GET', '/api/studies/none')).status).toBe(404);
    expect((await ask('POST', own('P16', '/claim'), { json: { invitation: 'AAAA' } })).status).toBe(404);
    expect((await ask('POST', own('Anna', '/claim'), { json: {} })).status).toBe(400);
    expect((await ask('GET', '/api/studies/paper/nothing', { token: experimenter })).status).toBe(404);
    expect((await ask('PUT', '/api/studies/paper')).status).toBe(405);
    expect((await ask('GET', own('P01', '/commands?after=soon'), { token })).status).toBe(400);
  });

  test('a body that grows past its limit while it arrives is cut off', async () => {
    const { ask, claim, store } = await servedPaperStudy();
    const token = await claim('P01');
    const endless = new ReadableStream({
      pull: (controller) => controller.enqueue(new Uint8Array(65_536).fill(0x20)),
    });
    const raw = {
      body: endless,
      duplex: 'half',
      headers: { 'content-type': 'application/json', authorization: `Bearer ${token}` },
    } as RequestInit;
    const outcome = await ask('POST', own('P01', '/records'), { raw }).then(
      ({ status }) => status,
      () => 'cut off',
    );
    expect([413, 'cut off']).toContain(outcome);
    expect(store.records.all('paper')).toEqual([]);
  });

  test('a full disk is said as 507; what was there stays, and deleting makes room again', async () => {
    const { ask, claim, store } = await servedPaperStudy({}, { maxBytes: 400 * 1024 });
    const tokens = [await claim('P01'), await claim('P02')];
    const own1 = completed('P01');
    expect((await ask('POST', own('P01', '/records'), { token: tokens[0]!, json: { records: own1 } })).status).toBe(
      200,
    );
    const remark = () => ask('POST', own('P01', '/remarks'), { token: experimenter, json: { text: 'x'.repeat(2000) } });
    let stored = 0;
    let last = await remark();
    while (last.status === 201 && stored < 1000) {
      stored += 1;
      last = await remark();
    }
    expect(last.json.error).toBe('the disk of the server is full: nothing was stored');
    const second = () =>
      ask('POST', own('P02', '/records'), { token: tokens[1]!, json: { records: completed('P02') } });
    const refused = [last.status, (await second()).status];
    expect(refused).toEqual([507, 507]);
    const lost = own1.length + stored - store.records.all('paper', 'P01').length;
    expect(lost).toBe(0);
    expect((await ask('DELETE', own('P01'), { token: experimenter })).status).toBe(200);
    expect((await second()).status).toBe(200);
    reportFigures('full-disk', {
      answers: refused.join(', '),
      'acknowledged and lost': lost,
      'stored once there is room': 'yes',
    });
  });
});
