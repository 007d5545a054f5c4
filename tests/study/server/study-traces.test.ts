import { mkdirSync, readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import { unzipSync } from 'fflate';
import { writeRecording } from 'threepoint/core';
import { expect, test } from 'vitest';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import type { StudyRecord } from '../../../src/study/model/records/study-record';
import { reportFigures } from '../../reliability/report-figures';
import { forkServer } from '../../server/server-child';
import { experimenterToken } from '../../server/started-server';
import { directoryWith } from '../../temporary-directory';
import { paperPlan, session } from '../model/studies';
import type { Anything } from './running-studies';

const plan = paperPlan();
const people = ['P01', 'P02', 'P03'];
/** Returns the mark in every text that a participant sends. */
const markOf = (participant: string) => `conspicuous-${participant.toLowerCase()}`;
const addressOf = (participant: string) => `203.0.113.${40 + Number(participant.slice(1))}`;

/** Returns a complete session of a participant, with the mark in every text. */
function sessionOf(participant: string) {
  const schedule = scheduleFor(plan, participant);
  const one = session(schedule);
  one.tell({ type: 'consent', version: schedule.consentVersion, motion: true });
  one.doUntil(({ kind }) => kind === 'questionnaire');
  one.tell({ type: 'remark', text: `${markOf(participant)} says so` });
  const { progress } = one;
  one.doUntil(({ kind }) => kind === 'end');
  const records = one.records.map((record) => {
    const { kind, body } = record as Anything;
    if (kind === 'demographics') {
      return { ...record, body: { ...body, major: markOf(participant), vrSystems: `${markOf(participant)} 2` } };
    }
    if (kind !== 'trial') return record;
    return {
      ...record,
      body: { ...body, outcome: { ...body.outcome, device: { ...body.outcome.device, name: markOf(participant) } } },
    };
  }) as StudyRecord[];
  return { records, progress };
}

function recordingOf(participant: string): string {
  const random = Number(participant.slice(1));
  const frames = Array.from({ length: 720 }, (_, index) => ({
    time: 1 + index / 72,
    head: {
      position: { x: Math.sin(index * random), y: 1.6, z: Math.cos(index * random) },
      orientation: { x: 0, y: 0, z: 0, w: 1 },
      tracking: 'tracked' as const,
    },
    leftHand: null,
    rightHand: null,
  }));
  return writeRecording({ device: markOf(participant), rateHz: 72, calibration: null, frames });
}

/** Starts a server whose temporary files and data are below one directory. */
async function serve() {
  const directory = directoryWith();
  mkdirSync(join(directory, 'temporary'));
  const server = await forkServer(
    { THREEPOINT_LOG_LEVEL: 'trace', THREEPOINT_TRUST_PROXY: '1', TMPDIR: join(directory, 'temporary') },
    { directory },
  );
  const ask = async (method: string, path: string, from: string, token: string | null, body?: unknown) => {
    const response = await fetch(`${server.url}/api/studies${path}`, {
      method,
      headers: {
        'x-forwarded-for': from,
        'user-agent': `a browser at ${from}`,
        // The search for traces blocks this process for longer than the server keeps an idle connection.
        connection: 'close',
        ...(token !== null && { authorization: `Bearer ${token}` }),
        ...(body !== undefined && { 'content-type': 'application/json' }),
      },
      ...(body !== undefined && { body: typeof body === 'string' ? body : JSON.stringify(body) }),
    });
    const bytes = new Uint8Array(await response.arrayBuffer());
    expect(response.status, `${method} ${path}: ${Buffer.from(bytes).toString().slice(0, 200)}`).toBeLessThan(300);
    return bytes;
  };
  const asExperimenter = (method: string, path: string, body?: unknown) =>
    ask(method, path, '198.51.100.7', experimenterToken, body);
  return { ...server, ask, asExperimenter };
}

type Served = Awaited<ReturnType<typeof serve>>;

/** Completes a session over HTTP; resolves with the token, the code and the records. */
async function takePart({ ask, asExperimenter }: Served, participant: string) {
  const from = addressOf(participant);
  const own = `/${plan.id}/participants/${participant}`;
  const claim = JSON.parse(Buffer.from(await asExperimenter('POST', `${own}/claim`, {})).toString()) as Anything;
  const { records, progress } = sessionOf(participant);
  await ask('POST', `${own}/records`, from, claim.token, { records });
  await ask('PUT', `${own}/progress`, from, claim.token, progress);
  for (const { id } of records.filter(({ kind }) => kind === 'trial').slice(0, 2)) {
    await ask('PUT', `${own}/motion?trial=${encodeURIComponent(id)}`, from, claim.token, recordingOf(participant));
  }
  await asExperimenter('POST', `${own}/remarks`, { text: `${markOf(participant)} wore a hat` });
  await asExperimenter('POST', `${own}/commands`, { type: 'stop', by: 'experimenter', reason: markOf(participant) });
  await ask('GET', `${own}/export`, from, claim.token);
  return { token: claim.token as string, code: claim.withdrawalCode as string, records };
}

const filesIn = (directory: string) =>
  readdirSync(directory, { recursive: true, encoding: 'utf8' })
    .filter((name) => statSync(join(directory, name)).isFile())
    .map((name) => ({ name, bytes: readFileSync(join(directory, name)) }));

/**
 * Returns what identifies a participant on a disk: texts, secrets, the address, and the middle of the compressed
 * recording.
 */
const tracesOf = (participant: string, { token, code }: { readonly token: string; readonly code: string }) => [
  ...[markOf(participant), token, code, code.replaceAll('-', ''), addressOf(participant)],
  gzipSync(recordingOf(participant)).subarray(4000, 4032),
];

test('a deleted participant leaves no byte in data, logs and files, and a code in exports', {
  tags: ['full'],
}, async () => {
  const server = await serve();
  const { ask, asExperimenter, directory } = server;
  const searched = () => [...filesIn(directory), { name: 'log', bytes: Buffer.from(server.printed()) }];
  await asExperimenter('POST', '', { plan, simulated: false });
  const taken: Record<string, Awaited<ReturnType<typeof takePart>>> = {};
  for (const participant of people) taken[participant] = await takePart(server, participant);
  await asExperimenter('GET', `/${plan.id}/export`);

  const found = (participant: string) =>
    searched().flatMap(({ name, bytes }) =>
      tracesOf(participant, taken[participant] as Anything)
        .filter((trace) => bytes.includes(trace))
        .map((trace) => `${name}: ${trace}`),
    );
  expect(found('P01').length, 'what a search finds before').toBeGreaterThan(1);
  await ask('POST', `/${plan.id}/withdraw`, addressOf('P01'), null, { code: taken.P01?.code });
  await asExperimenter('DELETE', `/${plan.id}/participants/P02`);
  const left = ['P01', 'P02'].flatMap(found);
  expect(left).toEqual([]);
  expect(found('P03').length).toBeGreaterThan(1);
  expect(
    found('P03').filter((trace) => trace.includes(addressOf('P03'))),
    'addresses',
  ).toEqual([]);

  const zip = unzipSync(await asExperimenter('GET', `/${plan.id}/export`));
  const exported = (participant: string, trace: string) =>
    Object.entries(zip)
      .filter(([name, bytes]) => name.includes(trace) || Buffer.from(bytes).includes(trace))
      .map(([name]) => `${participant} ${name}`);
  expect(['P01', 'P02'].flatMap((one) => exported(one, markOf(one)))).toEqual([]);
  expect(['P01', 'P02'].flatMap((one) => exported(one, `sub-${one}`))).toEqual([]);
  expect(exported('P03', markOf('P03')).length).toBeGreaterThan(3);
  expect(exported('P03', 'sub-P03').length).toBeGreaterThan(3);
  reportFigures('study-traces', {
    'traces of two participants in data, logs and temporary files': left.length,
    'files of the export of a study that show them': 0,
    'files searched': searched().length + Object.keys(zip).length,
  });
});
