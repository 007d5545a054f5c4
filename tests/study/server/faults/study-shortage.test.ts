import { once } from 'node:events';
import { Agent, request as httpRequest, type IncomingMessage } from 'node:http';
import { connect } from 'node:net';
import { join } from 'node:path';
import { expect, onTestFinished, test } from 'vitest';
import { recordVersion, type StudyRecord } from '../../../../src/study/model/records/study-record';
import { openStudyStore } from '../../../../src/study/server/sqlite/study-store';
import { reportFigures } from '../../../reliability/report-figures';
import { forkServer } from '../../../server/server-child';
import { experimenterToken, type StartedServer } from '../../../server/started-server';
import { directoryWith } from '../../../temporary-directory';
import { consentAt, paperPlan } from '../../model/studies';

/** Returns a folder with a study in which P01 has stored this number of remarks of 2 kB, and P01's withdrawal code. */
function studyWith(remarks: number) {
  const directory = directoryWith({ 'studies/.keep': '' });
  const file = join(directory, 'studies/studies.db');
  const store = openStudyStore(file);
  const at = Date.now() / 1000;
  store.plans.add(paperPlan(), { simulated: false, at });
  const base = { version: recordVersion, study: 'paper', simulated: false } as const;
  const codes: (string | null)[] = [];
  for (let number = 0; number <= remarks / 5000; number++) {
    const participant = `P0${number + 1}`;
    codes.push(store.places.claim('paper', participant, at).withdrawalCode);
    const rest = Array.from({ length: Math.min(5000, remarks - 5000 * number) }, (_, index): StudyRecord => {
      const text = `${index} `.padEnd(2000, 'a remark ');
      return { ...base, participant, at, id: `event-${index}`, kind: 'event', body: { type: 'remark', text } };
    });
    store.records.store('paper', participant, [consentAt(at, participant), ...rest], at);
  }
  store.close();
  return { directory, file, code: codes[0] };
}

/** A permanent connection, because no other one can be opened later. */
const agent = new Agent({ keepAlive: true, maxSockets: 1 });

async function ask({ port }: StartedServer, method: string, path: string, body?: unknown) {
  const headers = { authorization: `Bearer ${experimenterToken}`, 'content-type': 'application/json' };
  const request = httpRequest({ port, agent, method, headers, path: `/api/studies/paper${path}` });
  request.end(body === undefined ? undefined : JSON.stringify(body));
  const [response] = (await once(request, 'response')) as [IncomingMessage];
  const bytes = Buffer.concat(await response.toArray());
  const status = response.statusCode ?? 0;
  const { error } = status < 400 ? { error: null } : (JSON.parse(bytes.toString()) as { error: string });
  return { status, bytes, error };
}

const remark = (server: StartedServer) => ask(server, 'POST', '/participants/P01/remarks', { text: 'still here' });

test('a heap of 64 MB refuses an excess with a sentence, and the server goes on', {
  tags: ['full'],
}, async () => {
  const { directory } = studyWith(30_000);
  const server = await forkServer({ NODE_OPTIONS: '--max-old-space-size=64' }, { directory });
  const exported = await ask(server, 'GET', '/export');
  expect(exported.status).toBe(507);
  expect(exported.error).toMatch(/^The server is out of memory\. Give it more: .*one by one\.$/);
  const records = await ask(server, 'GET', '/records');
  expect(JSON.parse(records.bytes.toString()).records).toHaveLength(30_007);
  expect((await remark(server)).status).toBe(201);
  expect((await ask(server, 'GET', '/participants/P07/export')).status).toBe(200);
  expect(server.faults()).toEqual([]);
  reportFigures('study-shortage', {
    'heap of 64 MB': `an export of 60 MB of records ${exported.status}, the same records as JSON ${records.status}`,
  });
});

test('a limit of files reached by strangers leaves studies writable and refuses exports', {
  tags: ['full'],
}, async () => {
  const { directory } = studyWith(1);
  const through = ['bash', '-c', 'ulimit -n 100; exec "$0" "$@"'];
  const server = await forkServer({}, { directory, through });
  // The connection of the requests stays open.
  expect((await remark(server)).status).toBe(201);
  const strangers = Array.from({ length: 200 }, () => connect(server.port, '127.0.0.1'));
  for (const stranger of strangers) stranger.on('error', () => stranger.destroy());
  // The server closes the other connections after a while, because they send nothing.
  let exported = await ask(server, 'GET', '/export');
  while (exported.status === 200) exported = await ask(server, 'GET', '/export');
  const answers = [await remark(server), await remark(server)];
  for (const stranger of strangers) stranger.destroy();
  expect(answers.map(({ status }) => status)).toEqual([201, 201]);
  expect(exported.status).toBe(507);
  expect(exported.error).toMatch(/^The server has too many files open\. Raise the limit: ulimit -n 1024\./);
  await expect.poll(async () => (await ask(server, 'GET', '/export')).status).toBe(200);
  expect(server.faults()).toEqual([]);
  reportFigures('study-shortage', { '200 connections, 100 files': `writes 201, an export ${exported.status}` });
});

test('a disk that fills refuses to store and to delete, but not to export', { tags: ['full'] }, async () => {
  const { directory, file, code } = studyWith(100);
  // The limit is the size of the database in blocks of 1024 bytes. Further writes fail, as on a full disk.
  const through = ['bash', '-c', `trap '' XFSZ; ulimit -f 48; exec "$0" "$@"`];
  const server = await forkServer({}, { directory, through });
  let stored = 101;
  let answer = await remark(server);
  for (; answer.status === 201; answer = await remark(server)) stored += 1;
  expect([answer.status, answer.error]).toEqual([507, 'the database cannot be used: nothing was stored']);
  expect(await ask(server, 'DELETE', '/participants/P01')).toMatchObject({
    status: 507,
    error: 'the database cannot be used: nothing was deleted yet. Try again later',
  });
  expect(await ask(server, 'POST', '/withdraw', { code })).toMatchObject({
    status: 507,
    error: 'the database cannot be used: nothing was deleted yet. Try again later, or ask the experimenter',
  });
  const exported = await ask(server, 'GET', '/export');
  expect(exported.status).toBe(200);
  const records = JSON.parse((await ask(server, 'GET', '/records')).bytes.toString()).records as StudyRecord[];
  expect(records).toHaveLength(stored);
  expect(server.faults()).toEqual([]);
  const store = openStudyStore(file);
  onTestFinished(() => store.close());
  expect(store.records.all('paper')).toHaveLength(stored);
  store.records.addRemark('paper', 'P01', 'there is room again', Date.now() / 1000);
  expect(store.records.all('paper')).toHaveLength(stored + 1);
  reportFigures('study-shortage', {
    'disk full': `writes ${answer.status}, an export ${exported.status}, 0 acknowledged and lost`,
  });
});
