import { SignJWT } from 'jose';
import { clientAddressOf } from 'threepoint-http';
import { describe, expect, test } from 'vitest';
import { RoomTokens } from '../../src/relay/access/room-tokens';
import { relayConfigurationFrom } from '../../src/relay/settings/relay-configuration';
import { forkServer, sharedServer } from '../server/server-child';
import { testSecret } from '../server/started-server';
import { rawSocket, tokenFor, until } from './running-relay';
import { guestOfTest } from './until-finished';

const server = sharedServer({ THREEPOINT_TRUST_PROXY: '1' });

const post = (path: string, body: unknown, headers: Record<string, string> = {}) =>
  fetch(`${server.url}${path}`, {
    method: 'POST',
    headers: { 'content-type': 'application/json', ...headers },
    body: typeof body === 'string' ? body : JSON.stringify(body),
  });

describe('room tokens', () => {
  let now = 1_800_000_000;
  const tokens = new RoomTokens(testSecret, () => now);

  test('let one person into one room, and expire', async () => {
    const token = await tokens.issue('amber', 'ball');
    const pass = await tokens.verify(token);
    expect(pass).toMatchObject({ room: 'amber', kind: 'ball', terms: {} });
    now += 16 * 60;
    expect(await tokens.verify(token)).toBeNull();
    expect(await tokens.verifyRenewable(token)).toEqual(pass);
    expect((await tokens.verify(await tokens.sign(pass!)))?.identity).toBe(pass?.identity);
    now += 24 * 3600;
    expect(await tokens.verifyRenewable(token)).toBeNull();
  });

  test('are believed from no other address', async () => {
    const key = new TextEncoder().encode('another secret, also long enough to sign with');
    const forged = await new SignJWT({ room: 'amber', kind: 'ball' })
      .setProtectedHeader({ alg: 'HS256' })
      .setIssuer('threepoint')
      .setSubject('me')
      .setExpirationTime(now + 100)
      .sign(key);
    expect(await tokens.verify(forged)).toBeNull();
    const token = await tokens.issue('amber', 'ball');
    const [header, payload, signature] = token.split('.') as [string, string, string];
    const claims = JSON.parse(Buffer.from(payload, 'base64url').toString());
    const other = Buffer.from(JSON.stringify({ ...claims, room: 'birch' })).toString('base64url');
    expect(await tokens.verify(`${header}.${other}.${signature}`)).toBeNull();
    const unsigned = Buffer.from(JSON.stringify({ alg: 'none' })).toString('base64url');
    expect(await tokens.verify(`${unsigned}.${payload}.`)).toBeNull();
    for (const text of ['', 'x', 'a.b.c', 'x'.repeat(5000)]) expect(await tokens.verify(text)).toBeNull();
  });
});

describe('the relay over HTTP', () => {
  test('answers for its health, and tells metrics to this machine alone', async () => {
    const health = await fetch(`${server.url}/healthz`);
    expect(await health.json()).toMatchObject({ status: 'ok', rooms: 0 });
    const metrics = await fetch(`${server.url}/metrics`);
    expect(await metrics.text()).toContain('threepoint_poses_in_total 0');
    expect((await fetch(`${server.url}/metrics`, { headers: { 'x-forwarded-for': '9.9.9.9' } })).status).toBe(403);
  });

  test('signs the terms of a room, and keeps them when the pass is renewed', async () => {
    const tokens = new RoomTokens(testSecret, () => Date.now() / 1000);
    const asked = { room: 'terms', kind: 'ball' };
    const signed = async (body: object) => {
      const { token } = (await (await post('/api/rooms/token', body)).json()) as { token: string };
      return { token, pass: await tokens.verify(token) };
    };
    const { token, pass } = await signed({ ...asked, terms: { seconds: 45, balls: 6 } });
    expect(pass?.terms).toEqual({ seconds: 45, balls: 6 });
    expect((await signed({ ...asked, token })).pass).toEqual(pass);
  });

  test('lets five new people a minute in from one address, not counting holders of a pass', async () => {
    const from = { 'x-forwarded-for': '6.6.6.6, 203.0.113.7' };
    const asked = { room: 'amber', kind: 'ball' };
    const statuses: number[] = [];
    let token = '';
    for (let i = 0; i < 7; i++) {
      const response = await post('/api/rooms/token', asked, from);
      statuses.push(response.status);
      if (i === 0) token = ((await response.json()) as { token: string }).token;
    }
    expect(statuses).toEqual([200, 200, 200, 200, 200, 429, 429]);
    expect((await post('/api/rooms/token', { ...asked, token }, from)).status).toBe(200);
    expect((await post('/api/rooms/token', { ...asked, room: 'birch', token }, from)).status).toBe(429);
    expect((await post('/api/rooms/token', asked, { 'x-forwarded-for': '203.0.113.8' })).status).toBe(200);
  });

  test.each([
    ['no JSON', '{', 400],
    ['a room with a strange name', { room: '../etc', kind: 'ball' }, 400],
    ['an unknown kind', { room: 'amber', kind: 'chess' }, 400],
    ['a field too many', { room: 'amber', kind: 'ball', identity: 'me' }, 400],
    ['a long story', { room: 'amber', kind: 'ball', token: 'x'.repeat(5000) }, 413],
  ])('refuses %s', async (_what, body, status) => {
    expect((await post('/api/rooms/token', body)).status).toBe(status);
  });

  test('answers pages of its own origin', async () => {
    const asked = { room: 'amber', kind: 'ball' };
    expect((await post('/api/rooms/token', asked, { origin: 'https://evil.example' })).status).toBe(403);
    expect((await post('/api/rooms/token', asked, { origin: server.url })).status).toBe(200);
    expect((await post('/api/rooms/token', asked, { origin: server.url.replace('http:', 'https:') })).status).toBe(403);
  });

  test('believes the proxy about addresses only when told to', () => {
    const request = { headers: { 'x-forwarded-for': 'made up, 203.0.113.9' }, socket: { remoteAddress: '10.0.0.1' } };
    expect(clientAddressOf(request as never, true).text).toBe('203.0.113.9');
    expect(clientAddressOf(request as never, false).text).toBe('10.0.0.1');
  });

  test('finds a room with a free seat, and otherwise names a new one', async () => {
    const found = async () => (await post('/api/rooms/match', { kind: 'ball' })).json();
    expect(await found()).toMatchObject({ found: false });
    await guestOfTest(server.url, 'meadow');
    await expect.poll(found).toEqual({ room: 'meadow', found: true });
  });
});

describe('connecting', () => {
  const refusal = (token: string, room = 'amber') =>
    new Promise<string>((resolve) => {
      const socket = rawSocket(server.url, token, room);
      socket.on('connect', () => resolve('let in'));
      socket.on('connect_error', (error) => resolve(error.message));
    });

  test('takes a signed token, and no other', async () => {
    expect(await refusal('')).toBe('refused');
    expect(await refusal('nonsense')).toBe('refused');
    const foreign = new RoomTokens('a secret of some other server altogether', () => Date.now() / 1000);
    expect(await refusal(await foreign.issue('amber', 'ball'))).toBe('refused');
    const old = new RoomTokens(testSecret, () => Date.now() / 1000 - 3600);
    expect(await refusal(await old.issue('amber', 'ball'))).toBe('refused');
  });

  test('the room is the one of the token, even where the address names another', async () => {
    const token = await tokenFor(server.url, 'heath');
    const guest = await guestOfTest(server.url, 'birch', token);
    const welcome = guest.heard.find(({ type }) => type === 'welcome');
    expect(welcome).toMatchObject({ room: 'heath' });
  });

  test('a repeated token is the same person: the seat goes to the newer page', async () => {
    const token = await tokenFor(server.url, 'dell');
    const first = await guestOfTest(server.url, 'dell', token);
    const second = await guestOfTest(server.url, 'dell', token);
    await until('the first sent away', () => first.closedAt !== null);
    expect(first.heard.at(-1)).toEqual({ type: 'farewell', reason: 'replaced' });
    expect(second.heard.find(({ type }) => type === 'welcome')).toMatchObject({ seat: 0 });
  });
});

test('a relay that stops says so', async () => {
  const stopping = await forkServer();
  const guest = await guestOfTest(stopping.url, 'dusk');
  stopping.stop();
  await until('the end', () => guest.closedAt !== null);
  expect(guest.heard.at(-1)).toEqual({ type: 'farewell', reason: 'stopping' });
});

describe('configuration of the relay', () => {
  test('defaults play on this machine', () => {
    expect(relayConfigurationFrom({})).toMatchObject({ posesPerSecond: 40, eventsPerSecond: 10, joinsPerMinute: 5 });
  });

  test.each([
    [{ THREEPOINT_TICK_HZ: '1000' }, 'THREEPOINT_TICK_HZ must be a number from 20 to 120'],
    [{ THREEPOINT_TICK_HZ: 'fast' }, 'THREEPOINT_TICK_HZ'],
    [{ THREEPOINT_SECRET: 'short' }, 'THREEPOINT_SECRET has 5 characters; it needs 32'],
    [{ THREEPOINT_ADMIN_TOKEN: 'let-me-end-the-rooms' }, 'THREEPOINT_ADMIN_TOKEN has 20 characters; it needs 32'],
    [{ THREEPOINT_ADMIN_TOKEN: 'let me end '.repeat(4) }, 'THREEPOINT_ADMIN_TOKEN must have no spaces'],
    [{ THREEPOINT_ORIGINS: 'https://a.example/path' }, 'must list origins such as https://example.org'],
    [{ THREEPOINT_ORIGINS: 'a.example' }, 'must list origins'],
    [{ THREEPOINT_FILES_FROM: 'http://a.example' }, 'THREEPOINT_FILES_FROM must list origins'],
    [{ THREEPOINT_FILES_FROM: 'https://a.example/avatars/' }, 'THREEPOINT_FILES_FROM must list origins'],
    [{ THREEPOINT_FILES_FROM: 'https:' }, 'THREEPOINT_FILES_FROM must list origins'],
    [{ THREEPOINT_HOSTS: 'a.example:8080' }, 'must list names such as study.example.org'],
    [{ THREEPOINT_REDIS_URL: 'localhost:6379' }, 'must be like redis://localhost:6379'],
    [{ THREEPOINT_REDIS_URL: 'redis://localhost:6379' }, 'need the same THREEPOINT_SECRET'],
    [{ THREEPOINT_LOG_LEVEL: 'loud' }, 'must be one of trace'],
  ])('%o is refused with a sentence', (environment, words) => {
    expect(() => relayConfigurationFrom(environment)).toThrow(words);
  });

  test('origins are read without regard to a last slash', () => {
    const { origins } = relayConfigurationFrom({ THREEPOINT_ORIGINS: 'https://a.example/, http://b.example:8080' });
    expect(origins).toEqual(['https://a.example', 'http://b.example:8080']);
  });
});
