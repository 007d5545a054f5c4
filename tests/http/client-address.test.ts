import { once } from 'node:events';
import { BlockList, connect, Socket } from 'node:net';
import fc from 'fast-check';
import { afterAll, describe, expect, onTestFinished, test } from 'vitest';
import { parseClientAddress } from '../../src/http/client-address';
import { ConnectionLimiter } from '../../src/http/connection-limiter';
import { relayOfTest } from '../relay/until-finished';
import { reportFigures } from '../reliability/report-figures';
import { servedPaperStudy, servedStudies } from '../study/server/running-studies';

const host = (text: string) => `Host: ${text}\r\n`;

const proxiedRelay = () => relayOfTest({ THREEPOINT_TRUST_PROXY: '1' });

/** Sends a request of these lines and resolves to the status and the body of its answer. */
async function answerTo(port: number, lines: string): Promise<{ status: string; socket: Socket; text: string }> {
  const socket = connect({ port, host: '127.0.0.1' });
  onTestFinished(() => void socket.destroy());
  socket.write(`${lines}\r\n`);
  let text = '';
  while (!text.includes('\r\n\r\n')) text += String((await once(socket, 'data'))[0]);
  return { status: /^HTTP\/1\.1 (\d+)/.exec(text)?.[1] ?? 'none', socket, text };
}

const socketRequest = (headers: string, target = '/relay/?EIO=4&transport=websocket') =>
  `GET ${target} HTTP/1.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n${headers}`;

const joinRequest = (headers: string) => {
  const body = JSON.stringify({ room: 'amber', kind: 'ball' });
  return `POST /api/rooms/token HTTP/1.1\r\nContent-Type: application/json\r\nContent-Length: ${body.length}\r\n${headers}\r\n${body}`;
};

const from = (forwarded: string) => `${host('localhost')}X-Forwarded-For: ${forwarded}\r\n`;

/** Spellings of one client by index: each call may be another one. */
const clients: Readonly<Record<string, (i: number) => string>> = {
  'one IPv4 address with ports': (i) => `203.0.113.77:${2000 + i}`,
  'one IPv4 address, mapped, in brackets or plain': (i) =>
    ['203.0.113.77', '::ffff:203.0.113.77', '::FFFF:cb00:714d', `[::ffff:203.0.113.77]:${i}`][i % 4] as string,
  'one /64': (i) => `2001:db8:0:7:${i.toString(16)}::1`,
  'one /64 with brackets, ports and other spellings': (i) =>
    [`[2001:db8:0:7::1]:${2000 + i}`, '2001:0DB8:0000:0007:0:0:0:1', '[2001:db8::7:1:2:3:4]', '2001:db8:0:7::%eth0'][
      i % 4
    ] as string,
};

/** What each of the clients was granted. */
const passed = { joins: [] as number[], sockets: [] as number[], guesses: [] as number[] };
const tries = 40;
const socketTries = 300;
afterAll(() =>
  reportFigures('client-addresses', {
    clients: Object.keys(clients).join('; '),
    'joins, limit 5': `${passed.joins.join(', ')} of ${tries}`,
    'WebSockets, limit 256': `${passed.sockets.join(', ')} of ${socketTries}`,
    'wrong tokens checked, 5 without delay': `${passed.guesses.join(', ')} of ${tries}`,
  }),
);

describe.each(Object.entries(clients))('%s', (_name, spelling) => {
  test('is one client to the limit of new people', async () => {
    const { port } = await proxiedRelay();
    const statuses: string[] = [];
    for (let i = 0; i < tries; i++) statuses.push((await answerTo(port, joinRequest(from(spelling(i))))).status);
    const joins = statuses.filter((status) => status === '200').length;
    passed.joins.push(joins);
    expect(joins).toBe(5);
    expect(new Set(statuses.slice(5))).toEqual(new Set(['429']));
  });

  test('is one client to the limit of WebSockets', async () => {
    const limit = 256;
    const { port } = await proxiedRelay();
    const statuses: string[] = [];
    for (let i = 0; i < socketTries; i++)
      statuses.push((await answerTo(port, socketRequest(from(spelling(i))))).status);
    const sockets = statuses.filter((status) => status === '101').length;
    passed.sockets.push(sockets);
    expect(sockets).toBe(limit);
    expect(new Set(statuses.slice(limit))).toEqual(new Set(['429']));
  });

  test('is one client to the throttle of secrets', async () => {
    const { ask } = await servedStudies();
    const statuses: number[] = [];
    for (let i = 0; i < tries; i++) {
      statuses.push((await ask('GET', '/api/studies', { token: `wrong-${i}`, from: spelling(i) })).status);
    }
    const guesses = statuses.filter((status) => status === 401).length;
    passed.guesses.push(guesses);
    expect(guesses).toBeLessThanOrEqual(7);
    expect(new Set(statuses)).toEqual(new Set([401, 429]));
  });
});

test.each([
  ['203.0.113.7', '203.0.113.7', '203.0.113.7', false],
  ['::ffff:203.0.113.7', '203.0.113.7', '203.0.113.7', false],
  ['2001:0DB8:0000:0007:FFFF:1:2:3', '2001:db8:0:7:ffff:1:2:3', '2001:db8:0:7::/64', false],
  ['2001:db8::8:0:0:1', '2001:db8::8:0:0:1', '2001:db8::/64', false],
  ['fe80::1%eth0', 'fe80::1', 'fe80::/64', false],
  ['::1', '::1', '::/64', true],
  ['[::1]:3333', '::1', '::/64', true],
  ['127.8.9.10', '127.8.9.10', '127.8.9.10', true],
  ['::ffff:127.0.0.1', '127.0.0.1', '127.0.0.1', true],
])('%s is %s of %s', (written, text, network, isLoopback) => {
  expect(parseClientAddress(written)).toEqual({ text, network, isLoopback });
});

test('an IPv6 address lies in its network, and any text gives an address or null', () => {
  fc.assert(
    fc.property(fc.ipV6(), (text) => {
      const address = parseClientAddress(text);
      if (address?.text === address?.network) return;
      const network = new BlockList();
      network.addSubnet(address?.network.replace('/64', '') ?? '', 64, 'ipv6');
      expect(network.check(address?.text ?? '', 'ipv6')).toBe(true);
    }),
  );
  fc.assert(
    fc.property(fc.string(), (text) => {
      expect(() => parseClientAddress(text)).not.toThrow();
    }),
  );
});

test('connections without a proxy are counted by the /64, too', () => {
  const limiter = new ConnectionLimiter({ perAddress: 8, behindProxy: false });
  const admitted = Array.from({ length: 300 }, (_, i) => {
    const socket = new Socket();
    onTestFinished(() => void socket.destroy());
    Object.defineProperty(socket, 'remoteAddress', { value: `2001:db8:0:7::${(i + 1).toString(16)}` });
    return limiter.admit(socket);
  });
  expect(admitted.filter(Boolean)).toHaveLength(8);
  expect(limiter).toMatchObject({ open: 8, refused: 292 });
});

describe('a forwarded value that is no address', () => {
  test.each([
    'unknown',
    '203.0.113',
    '203.0.113.7:',
    '203.0.113.7:99999',
    '2001:db8::1]:443',
    '_hidden',
    '203.0.113.7,',
  ])('"%s" is refused with a sentence', async (value) => {
    const { port } = await proxiedRelay();
    for (const lines of [joinRequest(from(value)), socketRequest(from(value))]) {
      const { status, text } = await answerTo(port, lines);
      expect(status, lines).toBe('400');
      expect(text).toContain('X-Forwarded-For');
    }
  });

  test('is refused by the throttle of secrets and keeps no participant from their own place', async () => {
    const { ask, claim } = await servedPaperStudy();
    const token = await claim('P01');
    const wrong = await ask('GET', '/api/studies', { token: 'wrong', from: 'unknown' });
    expect(wrong.status).toBe(400);
    expect(wrong.json.error).toContain('X-Forwarded-For');
    const own = '/api/studies/paper/participants/P01/commands';
    expect((await ask('GET', own, { token, from: 'unknown' })).status).toBe(200);
    expect((await ask('GET', '/api/studies/paper', { from: 'unknown' })).status).toBe(200);
  });
});

describe('a request that names two servers', () => {
  const absolute = (authority: string) => `http://${authority}/healthz`;
  const get = (target: string, headers: string) => `GET ${target} HTTP/1.1\r\n${headers}`;

  test.each([
    ['two Host lines', get('/healthz', host('localhost') + host('evil.example')), '400'],
    ['two Host lines that are the same', get('/healthz', host('localhost') + host('localhost')), '400'],
    ['two Host lines of a WebSocket', socketRequest(host('localhost') + host('evil.example')), '400'],
    ['another authority in the target', get(absolute('evil.example'), host('localhost')), '400'],
    ['another port in the target', get(absolute('localhost:1'), host('localhost')), '400'],
    ['a name and a password in the target', get(absolute('a:b@localhost'), host('localhost')), '400'],
    [
      'another authority in the target of a WebSocket',
      socketRequest(host('localhost'), 'http://evil.example/relay/?EIO=4&transport=websocket'),
      '400',
    ],
    ['the authority of its Host in the target', get(absolute('LOCALHOST:80'), host('localhost')), '200'],
  ])('%s: %s', async (_what, lines, status) => {
    const { port } = await proxiedRelay();
    expect((await answerTo(port, lines)).status).toBe(status);
  });
});
