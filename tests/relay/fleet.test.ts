// @module-tag full

import { type ChildProcess, spawn } from 'node:child_process';
import { once } from 'node:events';
import type { AddressInfo } from 'node:net';
import { connect, createServer } from 'node:net';
import { fileURLToPath } from 'node:url';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { isNightly } from '../nightly';
import { printFigures } from '../print-figures';
import { installed } from '../server/installed';
import { head, offer, webSocket } from '../server/request-pipelines';
import { type StartedServer, startServer } from '../server/started-server';
import { arrive, pause, until } from './running-relay';

const programs = { haproxy: installed('haproxy'), redis: installed('redis-server') };
const missing = Object.values(programs).includes(null);
const config = fileURLToPath(new URL('../../deploy/haproxy.cfg', import.meta.url));

async function freePort(): Promise<number> {
  const server = createServer().listen(0, '127.0.0.1');
  await once(server, 'listening');
  const { port } = server.address() as AddressInfo;
  server.close();
  await once(server, 'close');
  return port;
}

async function listening(port: number): Promise<void> {
  let open = false;
  const end = performance.now() + 10_000;
  while (!open) {
    if (performance.now() > end) throw new Error(`nothing listens on port ${port}`);
    const socket = connect(port, '127.0.0.1');
    open = await Promise.race([
      once(socket, 'connect').then(() => true),
      once(socket, 'error').then(() => false),
    ]).catch(() => false);
    socket.destroy();
    if (!open) await pause(0.05);
  }
}

function run(program: string, args: readonly string[], environment: Record<string, string> = {}): ChildProcess {
  return spawn(program, args, { stdio: 'ignore', env: { ...process.env, ...environment } });
}

async function stop(child: ChildProcess | null): Promise<void> {
  if (!child || child.exitCode !== null || child.signalCode !== null) return;
  child.kill('SIGKILL');
  await once(child, 'exit');
}

const startRedis = async (port: number): Promise<ChildProcess> => {
  const redis = run(programs.redis!, ['--port', `${port}`, '--bind', '127.0.0.1', '--save', '', '--appendonly', 'no']);
  await listening(port);
  return redis;
};

const adminToken = 'fleet-kN3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gA';

interface Lobby {
  readonly rooms: readonly { readonly room: string; readonly players: number; readonly free: number }[];
  readonly complete: boolean;
}

const lobbyAt = async (url: string): Promise<Lobby> => (await fetch(`${url}/api/rooms`)).json() as Promise<Lobby>;

/** A number out of a process's metrics. */
async function metric(url: string, name: string): Promise<number> {
  const text = await (await fetch(`${url}/metrics`)).text();
  return Number(new RegExp(`^${name} (\\S+)$`, 'm').exec(text)?.[1] ?? Number.NaN);
}

const body = '{"kind":"ball"}';

/** Requests that follow each other on one connection, each with the status of its answer. */
const pipelined: readonly (readonly [request: string, status: string])[] = [
  [head('GET /'), '200'],
  [head('GET /%'), '400'],
  [head('GET /api/rooms', ...offer('h2c'), 'HTTP2-Settings: AAMAAABkAAQAAP__'), '200'],
  [head('POST /api/rooms/match', 'Content-Type: application/json', `Content-Length: ${body.length}`) + body, '200'],
  [head('GET /api/studies/%/records'), '400'],
  [head('GET /', ...offer('nothing/1')), '200'],
  [head('GET /relay/'), '426'],
  [head('HEAD /'), '200'],
  [head('GET /absent'), '404'],
];

/** Sends these requests at once on one connection, and resolves to the statuses of the answers. */
async function statusesOf(url: string, requests: readonly string[]): Promise<readonly string[]> {
  const socket = connect(Number(new URL(url).port), '127.0.0.1');
  let text = '';
  const statuses = () => [...text.matchAll(/HTTP\/1\.1 (\d{3}) /g)].map(([, status]) => status as string);
  socket.setEncoding('latin1').on('data', (chunk: string) => {
    text += chunk;
  });
  socket.write(requests.join(''));
  await until(`${requests.length} answers`, () => statuses().length >= requests.length || socket.closed, 120);
  socket.destroy();
  return statuses();
}

// Programs of the distribution, not ours to install: apt-get install haproxy redis-server
describe.skipIf(missing)(
  `two relay processes, Redis and a proxy${missing ? ' (haproxy or redis-server is not installed)' : ''}`,
  () => {
    let redis: ChildProcess | null = null;
    let redisPort = 0;
    let relays: StartedServer[] = [];
    let proxies: { readonly url: string; readonly process: ChildProcess }[] = [];
    let people: ReturnType<typeof arrive>[] = [];
    const rooms = ['amber', 'birch', 'cedar', 'daisy', 'elder', 'fern'];

    beforeAll(async () => {
      redisPort = await freePort();
      redis = await startRedis(redisPort);
      const environment = {
        THREEPOINT_REDIS_URL: `redis://127.0.0.1:${redisPort}`,
        THREEPOINT_TRUST_PROXY: '1',
        THREEPOINT_JOINS_PER_MINUTE: '1000',
        THREEPOINT_ADMIN_TOKEN: adminToken,
      };
      relays = await Promise.all([1, 2].map(() => startServer(environment)));
      proxies = await Promise.all(
        [0, 1].map(async () => {
          const port = await freePort();
          const process = run(programs.haproxy!, ['-f', config, '-db'], {
            PROXY_BIND: `127.0.0.1:${port}`,
            RELAY_1: `127.0.0.1:${relays[0]!.port}`,
            RELAY_2: `127.0.0.1:${relays[1]!.port}`,
          });
          await listening(port);
          return { url: `http://127.0.0.1:${port}`, process };
        }),
      );
      people = rooms.flatMap((room) => ['Ann', 'Ben', 'Cal'].map((name, i) => arrive(proxies[i % 2]!.url, room, name)));
    }, 60_000);

    afterAll(async () => {
      for (const person of people) person.stop();
      await Promise.all(relays.map((relay) => relay.kill()));
      await Promise.all(proxies.map(({ process }) => stop(process)));
      await stop(redis);
    });

    test('players meet in their rooms whichever address they came through, and both processes have rooms', async () => {
      await until(
        'each with their two others',
        () => people.every(({ connection }) => connection.room?.seats.every((row) => row?.presence === 'here')),
        30,
      );
      await until('each seen by their two others', () =>
        people.every(
          ({ poses, seat }) => new Set(poses.filter((pose) => pose.seat !== seat).map((pose) => pose.seat)).size === 2,
        ),
      );
      const carried = await Promise.all(relays.map(({ url }) => metric(url, 'threepoint_rooms')));
      printFigures('fleet', { rooms: rooms.length, 'in the first process': carried[0]!, 'in the second': carried[1]! });
      expect(carried[0]! + carried[1]!).toBe(rooms.length);
      expect(Math.min(...carried)).toBeGreaterThan(0);
    });

    test('the lobby knows the rooms of both, and finds a free seat in either', async () => {
      const lone = arrive(proxies[0]!.url, 'grove', 'Dot');
      people.push(lone);
      await until('Dot seated', () => lone.seat >= 0);
      for (const { url } of proxies) {
        const there = async () => {
          const { complete, rooms } = await lobbyAt(url);
          return { complete, rooms: rooms.map(({ room }) => room).sort() };
        };
        await expect.poll(there, { timeout: 10_000 }).toEqual({ complete: true, rooms: [...rooms, 'grove'] });
      }
      // Asked often enough to have been answered by both processes.
      for (let i = 0; i < 4; i++) {
        const response = await fetch(`${proxies[i % 2]!.url}/api/rooms/match`, {
          method: 'POST',
          headers: { 'content-type': 'application/json' },
          body: JSON.stringify({ kind: 'ball' }),
        });
        expect(await response.json()).toEqual({ room: 'grove', found: true });
      }
    });

    test('an authorised caller ends a room wherever it is; others do not', async () => {
      const end = (room: string, token: string) =>
        fetch(`${relays[0]!.url}/api/rooms/end`, {
          method: 'POST',
          headers: { 'content-type': 'application/json', authorization: `Bearer ${token}` },
          body: JSON.stringify({ room }),
        });
      // More than one, so that some are in the process that is not asked.
      const guests = ['heath', 'island', 'jetty', 'knoll'].map((room) => ({
        room,
        person: arrive(proxies[0]!.url, room, 'Eve'),
      }));
      await until('all in', () => guests.every(({ person }) => person.seat >= 0));
      expect((await end('heath', 'guessed')).status).toBe(403);
      for (const { room } of guests) expect((await end(room, adminToken)).status).toBe(200);
      await until('all out', () => guests.every(({ person }) => person.connection.status.reason === 'closed'));
      for (const { person } of guests) person.stop();
    });

    test('requests on one connection, among them upgrades, are answered in turn through the proxy', async () => {
      const requests = [
        ...Array.from({ length: isNightly ? 100 : 5 }, () => pipelined).flat(),
        [head('GET /relay/?EIO=4&transport=websocket&room=pipeline', ...webSocket(13)), '101'] as const,
      ];
      const connections = isNightly ? 50 : 20;
      const answers = await Promise.all(
        Array.from({ length: connections }, (_, i) =>
          statusesOf(
            proxies[i % 2]!.url,
            requests.map(([request]) => request),
          ),
        ),
      );
      for (const statuses of answers) expect(statuses).toEqual(requests.map(([, status]) => status));
      expect(relays.map((relay) => relay.isAlive())).toEqual([true, true]);
      expect(relays.map((relay) => relay.errors())).toEqual(['', '']);
      expect(people.every(({ connection }) => connection.status.phase === 'joined')).toBe(true);
      printFigures('pipelines through the proxy', { connections, answers: answers.flat().length });
    });

    test('without Redis every room goes on, and the lobby says that it is not complete', async () => {
      const threes = people.slice(0, 3 * rooms.length);
      const welcomes = () => threes.map(({ news }) => news.filter((word) => word === 'welcome').length);
      const welcomed = welcomes();
      await stop(redis);
      await expect.poll(async () => (await lobbyAt(proxies[0]!.url)).complete, { timeout: 15_000 }).toBe(false);
      expect((await lobbyAt(proxies[0]!.url)).rooms.length).toBeGreaterThan(0);
      for (const { poses } of threes) poses.length = 0;
      // Thirty a second of each of the two others.
      const wanted = 30 * 2 * (isNightly ? 30 : 4);
      await until('the poses of the others', () => threes.every(({ poses }) => poses.length >= wanted), 100);
      expect(threes.every(({ connection }) => connection.status.phase === 'joined')).toBe(true);
      expect(welcomes()).toEqual(welcomed);
      redis = await startRedis(redisPort);
      await expect
        .poll(async () => (await lobbyAt(proxies[0]!.url)).rooms.length, { timeout: 15_000, interval: 300 })
        .toBe(rooms.length + 1);
    });

    test('a process that is killed: its players are in their rooms on the other', async () => {
      await relays[0]!.kill();
      const start = performance.now();
      await until('the lost to notice', () => people.some(({ connection }) => connection.status.phase !== 'joined'));
      await until('all back', () => people.every(({ connection }) => connection.status.phase === 'joined'), 30);
      const took = (performance.now() - start) / 1000;
      await until('each with their others', () =>
        people
          .slice(0, 3 * rooms.length)
          .every(({ connection }) => connection.room?.seats.every((row) => row?.presence === 'here')),
      );
      printFigures('one process killed', {
        'all back after [s]': took,
        rooms: await metric(relays[1]!.url, 'threepoint_rooms'),
      });
      expect(await metric(relays[1]!.url, 'threepoint_rooms')).toBe(rooms.length + 1);
    });
  },
);
