import { connect, type Socket } from 'node:net';
import { setImmediate as nextTurn } from 'node:timers/promises';
import fc from 'fast-check';
import { expect, test } from 'vitest';
import { isNightly } from '../nightly';
import { reportFigures } from '../reliability/report-figures';
import { paperPlan } from '../study/model/studies';
import { answered, type Pipeline, type PipelinedRequest, pipelines } from './request-pipelines';
import { forkServer } from './server-child';
import { experimenterToken } from './started-server';

const atOnce = 60;
const answersWanted = isNightly ? 1_000_000 : 4000;
const patienceMs = 120_000;
let connections = 0;

/** Reads one answer from the start of the text: its status, its text and the rest; null: it is not complete. */
function readAnswer(text: string, isHead: boolean) {
  const end = text.indexOf('\r\n\r\n');
  if (end < 0) return null;
  const head = text.slice(0, end);
  const status = Number(/^HTTP\/1\.1 (\d{3}) /.exec(head)?.[1] ?? Number.NaN);
  const length = Number(/^content-length: (\d+)$/im.exec(head)?.[1] ?? 0);
  const bodyEnd = end + 4 + (isHead || status < 200 ? 0 : length);
  if (text.length < bodyEnd) return null;
  return { status, head, body: text.slice(end + 4, bodyEnd), rest: text.slice(bodyEnd) };
}

/** Reads the answers to these requests. Returns those that are complete, and the bytes after them. */
function readAnswers(text: string, requests: readonly PipelinedRequest[]) {
  const answers: NonNullable<ReturnType<typeof readAnswer>>[] = [];
  let rest = text;
  while (answers.length < requests.length) {
    const answer = readAnswer(rest, requests[answers.length]?.isHead ?? false);
    if (!answer) break;
    rest = answer.rest;
    if (answer.status !== 100) answers.push(answer);
  }
  return { answers, rest };
}

async function send(socket: Socket, { requests, cuts, isHalfClosed, leavesAt }: Pipeline): Promise<void> {
  const all = Buffer.from(requests.map(({ bytes }) => bytes).join(''), 'latin1');
  const bytes = leavesAt === null ? all : all.subarray(0, Math.floor(leavesAt * all.length));
  const ends = [...cuts.map((cut) => Math.floor(cut * bytes.length)).toSorted((a, b) => a - b), bytes.length];
  let sent = 0;
  for (const end of ends) {
    if (socket.destroyed) return;
    socket.write(bytes.subarray(sent, end));
    sent = end;
    await nextTurn();
  }
  if (leavesAt !== null) socket.destroy();
  else if (isHalfClosed) socket.end();
}

/** Sends a pipeline on a connection of its own, and resolves to the text that comes back. */
async function exchange(port: number, pipeline: Pipeline): Promise<string> {
  connections += 1;
  // The server limits what one address may do.
  const localAddress = `127.0.${(connections >> 8) & 255}.${1 + (connections % 250)}`;
  const socket = connect({ port, host: '127.0.0.1', localAddress });
  const wanted = answered(pipeline);
  const isWebSocket = wanted.at(-1)?.status === 101;
  const isOpenAfter = isWebSocket || !wanted.at(-1)?.isLast;
  let text = '';
  socket.on('error', () => undefined);
  socket.setTimeout(patienceMs, () => socket.destroy());
  socket.on('data', (chunk: Buffer) => {
    text += chunk.toString('latin1');
    if (isOpenAfter && readAnswers(text, wanted).answers.length === wanted.length) socket.destroy();
  });
  const closed = new Promise((resolve) => socket.once('close', resolve));
  // A WebSocket that is closed on one side is not opened.
  await send(socket, { ...pipeline, isHalfClosed: pipeline.isHalfClosed && !isWebSocket });
  await closed;
  return text;
}

/** Expects the answers of a pipeline, in order, and no more. Returns their number. */
function expectAnswers(text: string, pipeline: Pipeline): number {
  const wanted = answered(pipeline);
  const { answers, rest } = readAnswers(text, wanted);
  const said = `${pipeline.requests.map(({ name }) => name).join(', ')}: ${JSON.stringify(text.slice(0, 3000))}`;
  const statuses = answers.map(({ status }, i) => (status === 503 && wanted[i]?.isLimited ? wanted[i].status : status));
  expect(statuses, said).toEqual(wanted.map(({ status }) => status));
  if (wanted.at(-1)?.status !== 101) expect(rest, said).toBe('');
  answers.forEach(({ status, head, body }, i) => {
    if (status === wanted[i]?.status) expect(body, said).toContain(wanted[i].says ?? '');
    if (status !== 101) expect(head, said).toMatch(/^x-content-type-options: nosniff$/im);
  });
  return answers.length;
}

test('every request of a pipeline gets its answer in turn, and the built server lives on', {
  tags: ['full'],
  timeout: 7_200_000,
}, async () => {
  const server = await forkServer();
  const added = await fetch(`${server.url}/api/studies`, {
    method: 'POST',
    headers: { 'content-type': 'application/json', authorization: `Bearer ${experimenterToken}` },
    body: JSON.stringify({ plan: paperPlan(), simulated: true }),
  });
  expect(added.status).toBe(201);
  let answers = 0;
  let seed = 0;
  const exchangeInTurn = async (): Promise<void> => {
    while (answers < answersWanted) {
      seed += 1;
      const [pipeline] = fc.sample(pipelines, { numRuns: 1, seed });
      const text = await exchange(server.port, pipeline as Pipeline);
      expect(server.isAlive(), `seed ${seed}: ${server.errors()}`).toBe(true);
      if (pipeline?.leavesAt === null) answers += expectAnswers(text, pipeline);
    }
  };
  await Promise.all(Array.from({ length: atOnce }, exchangeInTurn));
  expect(server.errors()).toBe('');
  reportFigures('pipelines', { answers, 'missing or out of turn': 0, 'processes ended': 0, connections });
});
