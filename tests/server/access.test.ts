import { createHash, randomUUID } from 'node:crypto';
import { request as httpRequest, type OutgoingHttpHeaders } from 'node:http';
import { join } from 'node:path';
import { defaultCalibration } from 'threepoint/core';
import { games } from 'threepoint-games/all';
import { type BallState, ballKind } from 'threepoint-games/ball';
import { RoomTokens, relayConfigurationFrom } from 'threepoint-relay';
import type * as v from 'valibot';
import { afterAll, beforeAll, describe, expect, onTestFinished, test, vi } from 'vitest';
import { shippedRoomKinds } from '../../server/room-kinds';
import { startServer as startFromSource } from '../../server/start-server';
import { poseBytes, type RunningRelay, rawGuest, rawSocket, startRelay, tokenFor, until } from '../relay/running-relay';
import { guestOfTest } from '../relay/until-finished';
import { reportFigures } from '../reliability/report-figures';
import { begun, paperPlan, shortRecording } from '../study/model/studies';
import { studySeats } from '../study/server/running-studies';
import { startedStudy } from '../study/server/stored-studies';
import { directoryWith } from '../temporary-directory';
import { mannequin } from '../threepoint/avatar/glb';
import {
  type HttpRole,
  type HttpRow,
  httpRoles,
  httpRows,
  type MessageType,
  type SocketRole,
  socketRoles,
  socketRows,
  type TermRole,
  termRows,
  termValues,
} from './access-rows';
import { sharedServer } from './server-child';
import { experimenterToken, startServer, testSecret } from './started-server';

const adminToken = 'admin-kN3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gA';
const plan = paperPlan();
const trial = { step: 'ball/1/trial-1', run: 1 };

/** Starts the server as behind a proxy, with a study in which P01 and P02 take part and P03's place is free. */
async function startWithStudy() {
  const server = await startServer({ THREEPOINT_TRUST_PROXY: '1', THREEPOINT_ADMIN_TOKEN: adminToken });
  const study = startedStudy(join(server.directory, 'studies/studies.db'));
  return {
    port: server.port,
    ...study,
    async stop() {
      study.close();
      await server.kill();
    },
  };
}
type WholeServer = Awaited<ReturnType<typeof startWithStudy>>;

let current: WholeServer | null = null;
afterAll(() => current?.stop());

/** Returns the server of the last test, or a new one after a test that gave a place away or deleted it. */
async function wholeServer(): Promise<WholeServer> {
  if (current?.isAsBegun()) return current;
  await current?.stop();
  current = await startWithStudy();
  return current;
}

function bodyOf({ json }: HttpRow, { records }: WholeServer): string | undefined {
  if (json === 'motion') return shortRecording;
  if (json === undefined) return undefined;
  const bodies = {
    plan: { plan: { ...plan, id: 'another' }, simulated: false },
    records: { records },
    progress: begun(plan, 'P01'),
    seat: trial,
  };
  return JSON.stringify(typeof json === 'string' ? bodies[json] : json);
}

interface Sent {
  readonly headers: OutgoingHttpHeaders;
  readonly body?: string | Uint8Array | undefined;
}

const statusOf = (port: number, method: string, path: string, { headers, body }: Sent): Promise<number> =>
  new Promise((resolve, reject) => {
    const type =
      body === undefined ? {} : { 'content-type': 'application/json', 'content-length': Buffer.byteLength(body) };
    const request = httpRequest({ port, method, path, agent: false, headers: { ...type, ...headers } }, (response) => {
      response.resume().on('end', () => resolve(response.statusCode ?? 0));
    });
    request.on('error', reject).end(body);
  });

/** How a request of this role says who it is; each from an address of its own. */
function headersOf(role: HttpRole, { port, claims }: WholeServer): OutgoingHttpHeaders {
  const bearer = (token: string) => ({ authorization: `Bearer ${token}` });
  const from = { 'x-forwarded-for': `203.0.113.${Object.keys(httpRoles).indexOf(role) + 1}` };
  const host = `localhost:${port}`;
  const headers: Record<HttpRole, OutgoingHttpHeaders> = {
    stranger: { host },
    network: { host: `192.168.7.20:${port}`, origin: `http://192.168.7.20:${port}` },
    otherSite: { host, origin: 'http://evil.example', ...bearer(experimenterToken) },
    pointedHere: { host: `evil.example:${port}`, origin: `http://evil.example:${port}`, ...bearer(experimenterToken) },
    participant: { host, origin: `http://${host}`, ...bearer(claims.P01.token) },
    otherParticipant: { host, origin: `http://${host}`, ...bearer(claims.P02.token) },
    experimenter: { host, origin: `http://${host}`, ...bearer(experimenterToken) },
  };
  return { ...from, ...headers[role] };
}

let cells = 0;
let differing = 0;
const count = (asExpected: boolean): void => {
  cells += 1;
  if (!asExpected) differing += 1;
};
afterAll(() => reportFigures('access', { cells, 'cells that differ from docs/security.md': differing }));

test('every route of the server has a row, and every row a route', async () => {
  // From its sources: the built server does not list its routes.
  const { routes, close } = await startFromSource({
    pageDirectory: directoryWith({ 'index.html': 'the page' }),
    studyDirectory: directoryWith(),
    experimenterToken,
    relay: relayConfigurationFrom({ THREEPOINT_LOG_LEVEL: 'silent' }),
    games: await shippedRoomKinds({}),
    secret: testSecret,
    host: '127.0.0.1',
    port: 0,
    log: (line) => expect(line).toBeNull(),
  });
  onTestFinished(close);
  const known = routes.map(({ method, path }) => `${method} ${path}`);
  expect(Object.keys(httpRows).toSorted()).toEqual([...known, 'GET /'].toSorted());
  reportFigures('access', { 'routes and messages': known.length + Object.keys(socketRows).length });
});

const avatarFile = { bytes: new Uint8Array(mannequin()), hash: '' };
avatarFile.hash = createHash('sha256').update(avatarFile.bytes).digest('base64url');

/** What a player on a seat of the room called meadow gets who has stored the avatar. */
async function statusForPlayer(port: number, method: string, address: string): Promise<number> {
  const origin = `http://localhost:${port}`;
  const token = await tokenFor(origin, 'meadow');
  const guest = await guestOfTest(origin, 'meadow', token);
  // The seat is free for the next test.
  onTestFinished(() => void guest.say({ type: 'leave' }));
  const headers = { host: `localhost:${port}`, authorization: `Bearer ${token}` };
  const store = () =>
    statusOf(port, 'PUT', `/api/avatars/${avatarFile.hash}?room=meadow`, {
      headers: { ...headers, 'content-type': 'model/gltf-binary' },
      body: avatarFile.bytes,
    });
  if (method === 'PUT') return store();
  await store();
  return statusOf(port, method, address, { headers });
}

/** Who changes least goes first, so that what one is given changes nothing for the next. */
const order: readonly HttpRole[] = [
  'stranger',
  'network',
  'otherSite',
  'pointedHere',
  'otherParticipant',
  'participant',
  'experimenter',
];

describe.each(Object.entries(httpRows))('%s', (name, row) => {
  const [method, path] = name.split(' ') as [string, string];
  // Its own place is taken already: a free one is claimed.
  const participant = path.endsWith('/claim') ? 'P03' : 'P01';
  const address =
    path.replace(':study', 'paper').replace(':participant', participant).replace(':hash', avatarFile.hash) +
    (row.query ?? '');

  test(`${order.map((role) => `${role} ${row.status[role]}`).join(', ')}`, async () => {
    const server = await wholeServer();
    for (const role of order) {
      const sent = { headers: headersOf(role, server), body: bodyOf(row, server) };
      const status = await statusOf(server.port, method, address, sent);
      count(status === row.status[role]);
      expect(status, `${name}, ${httpRoles[role]}`).toBe(row.status[role]);
    }
  });

  const { also } = row;
  if (!also) return;
  test(`${also.who} ${also.status}`, async () => {
    const server = await wholeServer();
    const host = `localhost:${server.port}`;
    if (also.who === 'player') {
      const status = await statusForPlayer(server.port, method, address);
      count(status === also.status);
      expect(status).toBe(also.status);
      return;
    }
    const secrets = {
      invited: { headers: { host }, json: { invitation: server.invitation } },
      withdrawing: { headers: { host }, json: { code: server.claims.P01.withdrawalCode } },
      admin: { headers: { host, authorization: `Bearer ${adminToken}` }, json: row.json },
      'this machine': { headers: { host }, json: undefined },
    };
    const { headers, json } = secrets[also.who];
    const status = await statusOf(server.port, method, address, { headers, body: json && JSON.stringify(json) });
    count(status === also.status);
    expect(status).toBe(also.status);
  });
});

describe('a message to a room', () => {
  const relay = sharedServer();

  /** What rooms refused so far, by reason. */
  async function refusals(): Promise<ReadonlyMap<string, number>> {
    const metrics = await (await fetch(`${relay.url}/metrics`)).text();
    const sums = new Map<string, number>();
    for (const [, reason, number] of metrics.matchAll(/^threepoint_refusals_total\{.*reason="([\w-]+)".*\} (\d+)$/gm)) {
      sums.set(reason as string, (sums.get(reason as string) ?? 0) + Number(number));
    }
    return sums;
  }

  async function guestAs(role: SocketRole, room: string) {
    if (role === 'player') return rawGuest(relay.url, room);
    if (role === 'spectator') {
      const guest = await rawGuest(relay.url, room);
      guest.say({ type: 'sit', seat: null });
      await until('the seat given up', () => guest.heard.some(({ type }) => type === 'seated'));
      return guest;
    }
    const seat = await studySeats.sign(plan, 'P01', trial, role === 'experimenter');
    return rawGuest(relay.url, seat.room, seat.token);
  }

  const messages: Readonly<Record<Exclude<MessageType, 'join'>, unknown>> = {
    ready: { type: 'ready', ready: true },
    away: { type: 'away', away: true },
    sit: { type: 'sit', seat: 2 },
    calibration: { type: 'calibration', calibration: defaultCalibration },
    wear: { type: 'wear', avatar: 'a'.repeat(43) },
    voice: { type: 'voice', voice: { session: 'annas-page', muted: true } },
    signal: { type: 'signal', to: 'bens-page', body: { description: { type: 'offer', sdp: 'v=0' } } },
    pause: { type: 'pause', pause: true },
    ping: { type: 'ping', sent: 7 },
    leave: { type: 'leave' },
    action: { type: 'action', action: { type: 'drop', sequence: 1, side: 'left' } },
  };
  /** Reasons of admission; what the rules of a game refuse, everyone on a seat may try. */
  const reasons: readonly string[] = ['no-seat', 'not-pausable', 'assigned', 'no-voices'];

  async function outcomeOf(type: string, role: SocketRole, room: string): Promise<string> {
    const guest = await guestAs(role, room);
    const before = await refusals();
    if (type === 'pose') guest.pose(poseBytes(0));
    else if (type === 'unknown') guest.socket.emit('format-disk', {});
    else if (type !== 'join') guest.say(messages[type as keyof typeof messages]);
    if (type !== 'leave' && type !== 'unknown') {
      guest.say({ type: 'ping', sent: 9 });
      const answered = () => guest.heard.some((message) => message.type === 'pong' && message.sent === 9);
      await until('the answer', () => answered() || guest.closedAt !== null);
    } else await until('the end', () => guest.closedAt !== null);
    const left = guest.heard.some((message) => message.type === 'farewell' && message.reason === 'left');
    if (guest.closedAt !== null && !left) return 'ends';
    guest.socket.disconnect();
    const after = await refusals();
    return reasons.find((reason) => (after.get(reason) ?? 0) > (before.get(reason) ?? 0)) ?? 'taken';
  }

  test('has a row for every type', () => {
    const types = [...Object.keys(messages), 'join', 'pose', 'unknown'];
    expect(Object.keys(socketRows).toSorted()).toEqual(types.toSorted());
  });

  test.each(Object.entries(socketRows))('%s: as docs/security.md says', async (type, outcome) => {
    for (const role of Object.keys(socketRoles) as SocketRole[]) {
      const found = await outcomeOf(type, role, `room-of-${type}`);
      count(found === outcome[role]);
      expect(found, `${type}, ${socketRoles[role]}`).toBe(outcome[role]);
    }
  });

  test('comes from no one without a pass, and from no page of another site with one', async () => {
    const token = await tokenFor(relay.url, 'meadow');
    const refusal = (given: string, extraHeaders: Record<string, string>) =>
      new Promise<string>((resolve) => {
        const socket = rawSocket(relay.url, given, 'meadow', extraHeaders);
        socket.on('connect', () => resolve('let in'));
        socket.on('connect_error', (error) => resolve(error.message));
        socket.on('connect', () => socket.disconnect());
      });
    const { host } = new URL(relay.url);
    expect(await refusal(token, { origin: relay.url })).toBe('let in');
    expect(await refusal('', { origin: relay.url })).toBe('refused');
    for (const headers of [
      { origin: 'http://evil.example' },
      { origin: relay.url.replace('http:', 'https:') },
      { origin: 'null' },
      { host: 'evil.example', origin: 'http://evil.example' },
      { host: `${host}.evil.example`, origin: `http://${host}.evil.example` },
    ]) {
      expect(await refusal(token, headers), JSON.stringify(headers)).toBe('websocket error');
    }
    reportFigures('other-sites', { 'WebSockets of other sites refused': '5 of 5' });
  });
});

describe('the terms of a room', () => {
  // In this process, because a test reads the rooms of the relay.
  let relay: RunningRelay;
  beforeAll(async () => {
    relay = await startRelay();
  });
  afterAll(() => relay.close());
  const tokens = new RoomTokens(testSecret, () => Date.now() / 1000);
  const trialRoom = `study.${'0'.repeat(24)}`;

  const post = (path: string, body: object) =>
    fetch(`${relay.url}/api/rooms/${path}`, {
      method: 'POST',
      headers: { 'content-type': 'application/json' },
      body: JSON.stringify({ kind: ballKind, ...body }),
    });

  /** Tries to enter a room with a pass that has these terms. */
  async function outcomeOf(terms: object, role: TermRole): Promise<'taken' | 'refused'> {
    if (role === 'stranger') return (await post('token', { room: 'meadow', terms })).ok ? 'taken' : 'refused';
    const assigned = { seat: 0, name: 'P01' };
    const pass = { identity: randomUUID(), room: trialRoom, kind: ballKind, terms, assigned };
    const socket = rawSocket(relay.url, await tokens.sign(pass), trialRoom);
    onTestFinished(() => void socket.disconnect());
    return new Promise((resolve, reject) => {
      socket.on('connect', () => resolve('taken'));
      socket.on('connect_error', ({ message }) => (message === 'refused' ? resolve(message) : reject(message)));
    });
  }

  test.each(Object.entries(termRows))('%s: as docs/security.md says', async (term, { inside, outside, outcome }) => {
    for (const role of Object.keys(outcome) as TermRole[]) {
      for (const value of inside) expect(await outcomeOf({ [term]: value }, role), `${value}`).toBe(outcome[role]);
      for (const value of outside) expect(await outcomeOf({ [term]: value }, role), `${value}`).toBe('refused');
    }
  });

  test('have a row for every field of their schemas, and for every option that is none', async () => {
    expect(Object.keys(termRows).toSorted()).toEqual(Object.keys(termValues).toSorted());
    const { openTerms, assignedTerms } = await games.ball.rooms.createKind(90);
    for (const schema of [openTerms, assignedTerms]) {
      const fields = Object.keys((schema as v.StrictObjectSchema<v.ObjectEntries, undefined>).entries);
      expect(fields.length).toBeGreaterThan(0);
      expect(Object.keys(termRows)).toEqual(expect.arrayContaining(fields));
    }
  });

  test('are refused as a whole where one of them is', async () => {
    const good = { seconds: 3600, balls: 1 };
    expect(await outcomeOf(good, 'stranger')).toBe('taken');
    for (const [term, { inside, outcome }] of Object.entries(termRows)) {
      if (outcome.stranger === 'refused')
        expect(await outcomeOf({ ...good, [term]: inside[0] }, 'stranger'), term).toBe('refused');
    }
  });

  test('signed by a more generous release open no room, and are dropped from renewed passes', async () => {
    const room = 'before-the-update';
    const old = await tokens.sign({
      ...{ identity: randomUUID(), room, kind: ballKind, assigned: null },
      terms: { pausable: true, seconds: 3600 },
    });
    const refusal = await new Promise((resolve) => {
      const socket = rawSocket(relay.url, old, room);
      socket.on('connect', () => resolve('let in'));
      socket.on('connect_error', ({ message }) => resolve(message));
    });
    expect(refusal).toBe('refused');
    const { token } = (await (await post('token', { room, token: old })).json()) as { token: string };
    expect((await tokens.verify(token))?.terms).toEqual({});
    await rawGuest(relay.url, room, token);
  });

  test('a stranger’s terms lead nobody there by matchmaking, and stop no clock', async () => {
    const findRoom = async () => (await (await post('match', {})).json()) as { room: string; found: boolean };
    const enter = async (room: string, terms?: object) => {
      const { token } = (await (await post('token', { room, terms })).json()) as { token: string };
      return rawGuest(relay.url, room, token);
    };
    const listed = (room: string) => async () => {
      const { rooms } = (await (await fetch(`${relay.url}/api/rooms`)).json()) as { rooms: { room: string }[] };
      return rooms.some((each) => each.room === room);
    };
    const guests = [await enter('own-terms', { seconds: 3600, balls: 1 })];
    await vi.waitUntil(listed('own-terms'), 5000);
    expect((await findRoom()).room).not.toBe('own-terms');
    guests.push(await enter('usual'), await enter('usual', { seconds: 3600, balls: 1 }));
    await vi.waitUntil(listed('usual'), 5000);
    const found = await findRoom();
    expect(found).toEqual({ room: 'usual', found: true });
    guests.push(await enter(found.room));
    const match = relay.relay.rooms.get('usual')?.room.match as BallState | undefined;
    expect(match?.options).toMatchObject({ seconds: 90, balls: 20 });
    for (const guest of guests) {
      guest.say({ type: 'pause', pause: true });
      guest.say({ type: 'ping', sent: 9 });
      await until('the answer', () => guest.heard.some(({ type }) => type === 'pong'));
    }
    for (const room of ['own-terms', 'usual']) expect(relay.relay.rooms.get(room)?.room.paused).toBe(false);
    expect(await (await fetch(`${relay.url}/metrics`)).text()).toMatch(/reason="not-pausable".*\} 4$/m);
  });
});
