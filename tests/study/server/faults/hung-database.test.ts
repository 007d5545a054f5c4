import { spawn } from 'node:child_process';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { describe, expect, onTestFinished, test } from 'vitest';
import { recordVersion, type StudyRecord } from '../../../../src/study/model/records/study-record';
import { openStudyStore } from '../../../../src/study/server/sqlite/study-store';
import { isNightly } from '../../../nightly';
import { arrive, pause, until } from '../../../relay/running-relay';
import { reportFigures } from '../../../reliability/report-figures';
import { kill, messageFrom } from '../../../server/child-process';
import { installed } from '../../../server/installed';
import { forkServer } from '../../../server/server-child';
import { experimenterToken, type StartedServer } from '../../../server/started-server';
import { directoryWith } from '../../../temporary-directory';
import { consentAt, paperPlan } from '../../model/studies';

const now = 1_800_000_000;
/** The time for which the disk hangs, or another program holds the lock [s]. */
const hungSeconds = isNightly ? 30 : 12;
const lockedSeconds = isNightly ? 30 : 8;

/** Returns a folder with a study in which P01 has consented. */
function begunStudy() {
  const directory = directoryWith({ 'studies/.keep': '' });
  const file = join(directory, 'studies/studies.db');
  const store = openStudyStore(file);
  store.plans.add(paperPlan(), { simulated: false, at: now });
  const { token } = store.places.claim('paper', 'P01', now);
  store.records.store('paper', 'P01', [consentAt(now)], now);
  store.close();
  return { directory, file, token };
}

const remark = (number: number): StudyRecord => ({
  ...{ version: recordVersion, study: 'paper', participant: 'P01', simulated: false, at: now + number },
  ...{ id: `event-${number}`, kind: 'event', body: { type: 'remark', text: `remark ${number}` } },
});

/**
 * Three people in a room of this server who stand in a match's place and send poses; how late the poses of others come.
 */
async function playing(url: string) {
  const people = ['Ann', 'Ben', 'Cal'].map((name) => arrive(url, 'beside', name));
  onTestFinished(() => {
    for (const person of people) person.stop();
  });
  await until('all seated', () => people.every(({ connection }) => connection.room?.seats.every(Boolean)));
  return people;
}

/**
 * Sends writes and reads to the study until it is stopped, and keeps the status and the duration [s] of every answer.
 */
function studyTraffic(url: string, token: string) {
  const answers: { kind: 'write' | 'read'; status: number; seconds: number; retryAfter: string | null; id?: string }[] =
    [];
  let stopped = false;
  const own = `${url}/api/studies/paper/participants/P01`;
  const ask = async (kind: 'write' | 'read', number: number) => {
    const start = performance.now();
    const response = await fetch(kind === 'write' ? `${own}/records` : `${own}/commands?after=0`, {
      method: kind === 'write' ? 'POST' : 'GET',
      headers: { authorization: `Bearer ${token}`, 'content-type': 'application/json' },
      ...(kind === 'write' && { body: JSON.stringify({ records: [remark(number)] }) }),
    });
    await response.arrayBuffer();
    answers.push({
      ...{ kind, status: response.status, seconds: (performance.now() - start) / 1000 },
      ...{ retryAfter: response.headers.get('retry-after'), id: `event-${number}` },
    });
  };
  const loop = async (kind: 'write' | 'read', first: number) => {
    for (let number = first; !stopped; number++) {
      await ask(kind, number);
      await pause(0.2);
    }
  };
  const loops = [loop('write', 1_000_000), loop('write', 2_000_000), loop('read', 0)];
  return {
    answers,
    async stop() {
      stopped = true;
      await Promise.all(loops);
    },
  };
}

/** Asserts the answers of a room and the study while `hang` lasts, and that nothing acknowledged was lost. */
async function observed(
  server: StartedServer,
  { file, token }: ReturnType<typeof begunStudy>,
  hang: () => Promise<void>,
) {
  const people = await playing(server.url);
  await server.inspect();
  await pause(3);
  const before = (await server.inspect()).loop;
  for (const { poses } of people) poses.length = 0;
  const traffic = studyTraffic(server.url, token);
  const start = performance.now();
  await hang();
  const seconds = (performance.now() - start) / 1000;
  const meanwhile = (await server.inspect()).loop;
  const poses = people.map((person) => person.poses.length / seconds);
  await traffic.stop();
  const { answers } = traffic;
  const store = openStudyStore(file);
  onTestFinished(() => store.close());
  const ids = new Set(store.records.all('paper', 'P01').map(({ id }) => id));
  const acknowledged = answers.filter(({ kind, status }) => kind === 'write' && status === 200);
  const lost = acknowledged.filter(({ id }) => !ids.has(id as string));
  const refused = answers.filter(({ status }) => status !== 200);
  expect(refused.length).toBeGreaterThan(0);
  expect(refused.filter(({ status }) => status !== 503)).toEqual([]);
  expect(refused.filter(({ retryAfter }) => !/^\d+$/.test(retryAfter ?? ''))).toEqual([]);
  expect(lost).toEqual([]);
  expect(server.faults()).toEqual([]);
  // The defect would take seconds, more than a busy machine adds.
  expect(meanwhile.maxMs).toBeLessThan(1000);
  // 20 ms, or three times what the delay was before on a machine that is busy.
  expect(meanwhile.p99Ms).toBeLessThan(Math.max(20, 3 * before.p99Ms));
  expect(Math.min(...poses)).toBeGreaterThan(10);
  const reads = answers.filter(({ kind }) => kind === 'read');
  return {
    'hung for [s]': Math.round(seconds),
    'delay of the event loop, p99 before [ms]': before.p99Ms,
    'p99 meanwhile [ms]': meanwhile.p99Ms,
    'longest meanwhile [ms]': meanwhile.maxMs,
    'poses a second that each player received, at least': Math.min(...poses),
    'writes answered 503': refused.filter(({ kind }) => kind === 'write').length,
    'answered after, at most [s]': Math.max(...answers.map((answer) => answer.seconds)),
    'reads answered': `${reads.filter(({ status }) => status === 200).length} of ${reads.length}`,
    'answered 408': answers.filter(({ status }) => status === 408).length,
    'acknowledged and lost': lost.length,
  };
}

describe('a database that hangs', () => {
  test('by another program’s lock lets rooms go on, refuses writes for a time, answers reads', {
    tags: ['full'],
  }, async () => {
    const study = begunStudy();
    const server = await forkServer({}, { directory: study.directory });
    const script = fileURLToPath(new URL('./database-locker.ts', import.meta.url));
    const locker = spawn(process.execPath, ['--import', 'tsx', script, study.file], {
      stdio: ['inherit', 'inherit', 'inherit', 'ipc'],
    });
    onTestFinished(() => kill(locker));
    await messageFrom(locker);
    const figures = await observed(server, study, async () => {
      locker.send('lock');
      await messageFrom(locker);
      await pause(lockedSeconds);
      locker.send('unlock');
      await messageFrom(locker);
    });
    reportFigures('study-lock', figures);
  });

  const strace = installed('strace');

  /** Starts the server on a disk whose flushes strace delays. */
  async function onStuckDisk(study: ReturnType<typeof begunStudy>) {
    const delay = `-e inject=fsync,fdatasync:delay_enter=${1e6 * hungSeconds}`;
    const through = `${strace} -D -f --seccomp-bpf -qqq -o /dev/null -e trace=fsync,fdatasync ${delay}`.split(' ');
    return forkServer({}, { directory: study.directory, through });
  }

  test.skipIf(strace === null)(
    'by an unfinished flush lets rooms go on, acknowledges nothing, answers reads',
    { tags: ['full'] },
    async () => {
      const study = begunStudy();
      const server = await onStuckDisk(study);
      const figures = await observed(server, study, () => pause(hungSeconds - 1));
      reportFigures('study-disk', figures);
    },
  );

  test.skipIf(strace === null)(
    'because its disk does not finish what SQLite itself flushes: rooms go on, nothing is acknowledged',
    { tags: ['full'] },
    async () => {
      const study = begunStudy();
      const server = await onStuckDisk(study);
      const deleted = fetch(`${server.url}/api/studies/paper/participants/P02`, {
        method: 'DELETE',
        headers: { authorization: `Bearer ${experimenterToken}` },
      });
      const figures = await observed(server, study, () => pause(hungSeconds - 4));
      expect((await deleted).status).toBe(503);
      reportFigures('study-disk', {
        'p99 while SQLite itself flushes [ms]': figures['p99 meanwhile [ms]'],
        'longest then [ms]': figures['longest meanwhile [ms]'],
      });
    },
  );
});
