import { once } from 'node:events';
import type { RequestListener } from 'node:http';
import { connect, type Socket } from 'node:net';
import { connect as connectTls } from 'node:tls';
import { describe, expect, onTestFinished, test } from 'vitest';
import { ConnectionLimiter } from '../../src/http/connection-limiter';
import { noPage } from '../../src/http/router';
import { isNightly } from '../nightly';
import { relayOfTest } from '../relay/until-finished';
import { reportFigures } from '../reliability/report-figures';
import { servePage } from '../server/served-page';
import { forkServer, probeHealth } from '../server/server-child';
import { testCredentials } from '../server/test-credentials';
import { directoryWith } from '../temporary-directory';
import { serve } from './serve';

const upgradeRequest = (headers = '') =>
  `GET /relay/?EIO=4&transport=websocket HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n${headers}Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n`;

/** Collects what a connection receives; `said` grows. */
function listened(socket: Socket) {
  const connection = { socket, said: '', closed: false };
  socket.on('error', () => undefined);
  socket.on('data', (chunk) => {
    connection.said += chunk.toString('latin1');
  });
  socket.on('close', () => {
    connection.closed = true;
  });
  onTestFinished(() => void socket.destroy());
  return connection;
}

/** Opens a connection that sends this text and no more, and collects the answer. */
function raw(port: number, text: string, localAddress = '127.0.0.1') {
  const socket = connect({ port, host: '127.0.0.1', localAddress });
  if (text) socket.write(text);
  return listened(socket);
}

const statusOf = ({ said }: { readonly said: string }) => /^HTTP\/1\.1 (\d+)/.exec(said)?.[1] ?? 'none';

describe('a body that is not wanted', () => {
  /** Bytes that the system took from us before the server closed, and what it said. */
  async function pour(port: number, head: string): Promise<{ status: string; bytes: number }> {
    const connection = raw(port, head);
    const { socket } = connection;
    const chunk = Buffer.alloc(65_536);
    while (!connection.closed && socket.bytesWritten < 200e6) {
      if (!socket.write(chunk))
        await Promise.race([once(socket, 'drain'), once(socket, 'close')]).catch(() => undefined);
    }
    return { status: statusOf(connection), bytes: socket.bytesWritten };
  }

  test('is not read: the refusal is heard and the connection ends', async () => {
    const page = await servePage(directoryWith({ 'index.html': 'page' }));
    onTestFinished(() => page.close());
    const relay = await relayOfTest();
    const length = 'Host: localhost\r\nContent-Type: application/json\r\nContent-Length: 200000000\r\n\r\n';
    const chunked =
      'Host: localhost\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\nfffffff\r\n';
    const poured = {
      'POST / announced': await pour(page.port, `POST / HTTP/1.1\r\n${length}`),
      'POST / in chunks': await pour(page.port, `POST / HTTP/1.1\r\n${chunked}`),
      'POST /api/rooms/token announced': await pour(relay.port, `POST /api/rooms/token HTTP/1.1\r\n${length}`),
      'POST /api/rooms/token in chunks': await pour(relay.port, `POST /api/rooms/token HTTP/1.1\r\n${chunked}`),
      'PUT /api/rooms': await pour(relay.port, `PUT /api/rooms HTTP/1.1\r\n${length}`),
    };
    expect(Object.values(poured).map(({ status }) => status)).toEqual(['405', '405', '413', '413', '405']);
    const most = Math.max(...Object.values(poured).map(({ bytes }) => bytes));
    // The buffers of the system on both sides, and the mebibyte that the server drains.
    expect(most).toBeLessThan(32e6);
    reportFigures('unwanted-bodies', { 'most taken of 200 MB [MB]': most / 1e6 });
  });

  test('ends nothing where it is short: the next request on the connection is answered', async () => {
    const relay = await relayOfTest();
    const put = 'PUT /api/rooms HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n';
    const connection = raw(relay.port, put + put);
    await expect.poll(() => connection.said.split('HTTP/1.1 405').length - 1).toBe(2);
    expect(connection.closed).toBe(false);
  });
});

describe('connections', () => {
  test('a flood of silent ones from one address is counted, bounded and over after the deadline', {
    tags: ['full'],
  }, async () => {
    const flood = isNightly ? 1500 : 200;
    const limit = isNightly ? 1000 : 100;
    const server = await forkServer({ THREEPOINT_CONNECTIONS_PER_ADDRESS: String(limit) });
    const census = async () =>
      (await (await fetch(`${server.url}/healthz`)).json()) as {
        sockets: number;
        connections: number;
        refusedConnections: number;
      };
    const health = probeHealth(server.url);
    const { p95Ms: before } = await health(isNightly ? 300 : 60);
    const rssBefore = (await server.inspect()).rssBytes;
    const silent = Array.from({ length: flood }, (_, i) =>
      raw(server.port, i % 2 === 0 ? upgradeRequest() : '', '127.0.0.2'),
    );
    // The others are from another address. On a busy machine the first of the flood are over before the last have come.
    const most = { connections: 0, sockets: 0, rssBytes: 0 };
    const watch = async (): Promise<boolean> => {
      const [{ connections, sockets }, { rssBytes }] = await Promise.all([census(), server.inspect()]);
      most.connections = Math.max(most.connections, connections);
      most.sockets = Math.max(most.sockets, sockets);
      most.rssBytes = Math.max(most.rssBytes, rssBytes);
      return silent.every(({ closed }) => closed);
    };
    await expect.poll(watch, { timeout: 60_000, interval: 20 }).toBe(true);
    const { p95Ms: during, asked, healthy } = await health();
    expect(healthy).toBe(asked);
    const { refusedConnections } = await census();
    const answered = silent.filter((connection) => statusOf(connection) !== 'none');
    expect(refusedConnections).toBe(flood - answered.length);
    expect(refusedConnections).toBeGreaterThan(0);
    expect(most.connections).toBeGreaterThan(limit / 2);
    expect(most.connections).toBeLessThanOrEqual(limit + 10);
    expect(most.sockets).toBeGreaterThan(limit / 4);
    await expect.poll(async () => (await census()).connections, { timeout: 10_000 }).toBeLessThanOrEqual(10);
    const metrics = await (await fetch(`${server.url}/metrics`)).text();
    expect(metrics).toContain('threepoint_sockets 0');
    expect(metrics).toContain(`threepoint_connections_refused_total ${refusedConnections}`);
    reportFigures('connections', {
      'silent connections from one address': flood,
      [`open at once, at most (limit ${limit})`]: most.connections,
      'open after the deadline': silent.filter(({ closed }) => !closed).length,
      'memory [MB]': (most.rssBytes - rssBefore) / 1e6,
      'health for others, p95 before [ms]': before,
      'during [ms]': during,
    });
  });

  test('WebSockets behind a trusted proxy are counted by the address it gives, and no other proxy’s', async () => {
    const limit = 8;
    const proxied = await relayOfTest({
      THREEPOINT_CONNECTIONS_PER_ADDRESS: String(limit),
      THREEPOINT_TRUST_PROXY: '1',
    });
    const from = (address: string) => raw(proxied.port, upgradeRequest(`X-Forwarded-For: ${address}\r\n`));
    const statuses = async (connections: readonly ReturnType<typeof raw>[]) => {
      await expect.poll(() => connections.every((one) => statusOf(one) !== 'none')).toBe(true);
      return connections.map(statusOf);
    };
    const first = Array.from({ length: limit }, () => from('203.0.113.7'));
    expect(new Set(await statuses(first))).toEqual(new Set(['101']));
    expect(await statuses([from('203.0.113.7'), from('203.0.113.8')])).toEqual(['429', '101']);
    first[0]?.socket.destroy();
    await expect.poll(() => proxied.relay.census.sockets).toBe(limit);
    expect(await statuses([from('203.0.113.7')])).toEqual(['101']);

    const plain = await relayOfTest({ THREEPOINT_CONNECTIONS_PER_ADDRESS: String(limit) });
    const made = Array.from({ length: limit }, (_, i) =>
      raw(plain.port, upgradeRequest(`X-Forwarded-For: 203.0.113.${i}\r\n`)),
    );
    expect(new Set(await statuses(made))).toEqual(new Set(['101']));
    const another = raw(plain.port, upgradeRequest('X-Forwarded-For: 203.0.113.99\r\n'));
    await expect.poll(() => another.closed).toBe(true);
    expect(another.said).toBe('');
    // One that ends makes room for another of its address.
    made[0]?.socket.destroy();
    await expect.poll(() => plain.relay.census.connections).toBe(limit - 1);
    expect(await statuses([raw(plain.port, upgradeRequest())])).toEqual(['101']);
  });
});

test('a connection that does not state its purpose is ended at the deadline, over any protocol', {
  tags: ['full'],
}, async () => {
  const relay = await relayOfTest();
  const credentials = await testCredentials();
  const secure = await serve(noPage, { credentials });
  onTestFinished(() => secure.close());
  const connections = [
    ...['', 'GET / HTTP/1.1\r\nHost: local', upgradeRequest()].map((text) => raw(relay.port, text)),
    // Over TLS: as plain HTTP that is to be redirected, and after the handshake.
    ...['', 'GET / HTTP/1.1\r\nHost: local'].map((text) => raw(secure.port, text)),
    listened(connectTls({ port: secure.port, host: '127.0.0.1', ca: credentials.cert })),
  ];
  await expect.poll(() => relay.relay.census).toMatchObject({ sockets: 1, connections: 3 });
  // None of them answers a closing frame.
  await expect.poll(() => connections.every(({ closed }) => closed), { timeout: 15_000 }).toBe(true);
  // A connection that has sent neither TLS nor HTTP gets no answer in a protocol.
  expect(connections.map(statusOf)).toEqual(['408', '408', '101', 'none', '408', '408']);
  expect(relay.relay.census).toMatchObject({ sockets: 0, connections: 0 });
});

test('an answer that is not read is not kept for ever', { tags: ['full'] }, async () => {
  const connectionLimiter = new ConnectionLimiter({ perAddress: 8, behindProxy: false });
  const long: RequestListener = (_, response) => void response.end(Buffer.alloc(32e6));
  const server = await serve(long, { connectionLimiter, idleTimeoutMs: 500 });
  onTestFinished(() => server.close());
  const { socket } = raw(server.port, 'GET / HTTP/1.1\r\nHost: a\r\n\r\n');
  socket.pause();
  await expect.poll(() => connectionLimiter.open).toBe(1);
  await expect.poll(() => connectionLimiter.open, { timeout: 15_000 }).toBe(0);
});

test.each([
  [
    'an upgrade to another protocol is passed over',
    'GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: h2c\r\n\r\n',
    '200',
  ],
  ['a tunnel is refused', 'CONNECT example.org:443 HTTP/1.1\r\nHost: example.org:443\r\n\r\n', '405'],
  ['an expectation that is not met is said', 'GET /healthz HTTP/1.1\r\nHost: localhost\r\nExpect: tea\r\n\r\n', '417'],
  ['a request without a host is bad', 'GET /healthz HTTP/1.1\r\n\r\n', '400'],
  ['a head without end is too long', `GET /healthz HTTP/1.1\r\nHost: localhost\r\nLong: ${'x'.repeat(40_000)}`, '431'],
  ['what is no HTTP is told so', 'hello\r\n\r\n', '400'],
  ['the relay’s address without an upgrade asks for one', 'GET /relay/ HTTP/1.1\r\nHost: localhost\r\n\r\n', '426'],
  ['a WebSocket without a key is refused', upgradeRequest().replace(/Sec-WebSocket-Key.*\r\n/, ''), '400'],
  ['a WebSocket of another version is refused', upgradeRequest().replace('Version: 13', 'Version: 8'), '426'],
  ['polling is refused', upgradeRequest().replace('transport=websocket', 'transport=polling'), '400'],
  ['a foreign page is refused', upgradeRequest('Origin: https://evil.example\r\n'), '403'],
])('%s, with the headers of every answer', async (_what, text, status) => {
  const relay = await relayOfTest();
  const connection = raw(relay.port, text);
  await expect.poll(() => statusOf(connection)).toBe(status);
  expect(connection.said).toContain('x-content-type-options: nosniff');
  expect(connection.said).toContain('content-security-policy: ');
});
