import { connect } from 'node:net';
import fc from 'fast-check';
import { expect, test } from 'vitest';
import { isNightly } from '../nightly';
import { reportFigures } from '../reliability/report-figures';
import { paperPlan } from '../study/model/studies';
import { httpRows } from './access-rows';
import { rawRequests } from './raw-requests';
import { forkServer, probeHealth } from './server-child';
import { experimenterToken } from './started-server';

const atOnce = 20;
const batches = isNightly ? 5000 : 50;
const patienceMs = 20_000;
let sent = 0;

/**
 * Sends the bytes and no more on a connection of their own, and resolves to the first bytes that come back; empty: none
 * came.
 */
async function answerTo(port: number, bytes: Buffer): Promise<string> {
  sent += 1;
  // Every address of this machine in turn: what one may do is limited.
  const socket = connect({ port, host: '127.0.0.1', localAddress: `127.0.${(sent >> 8) & 255}.${1 + (sent % 250)}` });
  const chunks: Buffer[] = [];
  // A server that refuses may close before all is sent: what it said until then counts.
  socket.on('error', () => undefined);
  socket.setTimeout(patienceMs, () => socket.destroy());
  socket.on('data', (chunk: Buffer) => {
    chunks.push(chunk);
    if (chunks.length > 0) socket.destroy();
  });
  socket.end(bytes);
  await new Promise((resolve) => socket.once('close', resolve));
  return Buffer.concat(chunks).toString('latin1');
}

/** Empty lines alone are no request: nothing need be answered. */
const asks = (bytes: Buffer): boolean => /[^\r\n]/.test(bytes.toString('latin1'));

test('every request line, method, header and body gets an answer, and the server lives on', {
  tags: ['full'],
  timeout: 1_800_000,
}, async () => {
  const server = await forkServer();
  const health = probeHealth(server.url);
  const { p95Ms: idleP95Ms } = await health(100);
  let empty = 0;
  const statuses = new Map<string, number>();
  const added = await fetch(`${server.url}/api/studies`, {
    method: 'POST',
    headers: { 'content-type': 'application/json', authorization: `Bearer ${experimenterToken}` },
    body: JSON.stringify({ plan: paperPlan(), simulated: true }),
  });
  expect(added.status).toBe(201);
  const requests = rawRequests(Object.keys(httpRows));
  for (let seed = 0; seed < batches; seed++) {
    const batch = fc.sample(requests, { numRuns: atOnce, seed });
    const answers = await Promise.all(batch.map((bytes) => answerTo(server.port, bytes)));
    answers.forEach((answer, i) => {
      const bytes = batch[i] as Buffer;
      if (!asks(bytes)) {
        empty += 1;
        return;
      }
      const status = /^HTTP\/1\.1 (\d{3}) /.exec(answer)?.[1] ?? 'none';
      const said = `seed ${seed}: ${JSON.stringify(bytes.toString('latin1').slice(0, 500))}`;
      expect(status, said).not.toBe('none');
      // A fault of the server.
      expect(status, said).not.toBe('500');
      if (!status.startsWith('1')) expect(answer, said).toContain('x-content-type-options: nosniff');
      statuses.set(status, (statuses.get(status) ?? 0) + 1);
    });
    expect(server.isAlive()).toBe(true);
  }
  const { asked, healthy, p50Ms, p95Ms } = await health();
  expect(healthy).toBe(asked);
  expect(server.faults()).toEqual([]);
  await expect
    .poll(async () => ((await (await fetch(`${server.url}/healthz`)).json()) as { connections: number }).connections, {
      timeout: 30_000,
    })
    .toBeLessThanOrEqual(4);
  reportFigures('raw-requests', {
    requests: sent,
    'without an answer': sent - empty - [...statuses.values()].reduce((sum, count) => sum + count, 0),
    faults: server.faults().length,
    answers: [...statuses]
      .sort()
      .map(([status, count]) => `${status} × ${count}`)
      .join(', '),
    'health before, p95 [ms]': idleP95Ms,
    'health meanwhile, p50 [ms]': p50Ms,
    'p95 [ms]': p95Ms,
  });
});
