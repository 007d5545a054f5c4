import { readFile } from 'node:fs/promises';
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import { Vector3 } from 'three';
import { loadAvatar } from 'threepoint/api/three';
import { distance } from 'threepoint/core/math/vec3';
import { type JoinedRoom, type JoinRoomOptions, joinRoom } from 'threepoint-rooms/drawing/join-room';
import { type AttachRoomsOptions, attachRooms } from 'threepoint-rooms/server/attach-rooms';
import { expect, onTestFinished, test, vi } from 'vitest';
import { until } from '../server/running-relay';
import { solvedActor } from './solved-actor';

const mannequinFile = readFile('public/avatars/mannequin.vrm');

/** A server of somebody else's with rooms on it. */
async function served(options: AttachRoomsOptions = {}) {
  const server: Server = createServer((request, response) => response.end(`mine: ${request.url}`));
  const rooms = attachRooms(server, { logLevel: 'silent', ...options });
  await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
  onTestFinished(async () => {
    await rooms.close();
    server.closeAllConnections();
    await new Promise((resolve) => server.close(resolve));
  });
  return { rooms, server, url: `http://127.0.0.1:${(server.address() as AddressInfo).port}` };
}

/** A tab's storage. */
function storage() {
  const kept = new Map<string, string>();
  return {
    getItem: (key: string) => kept.get(key) ?? null,
    setItem: (key: string, value: string) => kept.set(key, value),
  };
}

/** A page that joins with an actor's body. */
async function joins(url: string, name: string, options: Partial<JoinRoomOptions> = {}) {
  const body = solvedActor();
  const avatar = vi.fn(async () => loadAvatar(await mannequinFile));
  const room = await joinRoom(url, { name, body, avatar, storage: null, ...options });
  onTestFinished(() => room.leave());
  return {
    room,
    avatar,
    body,
    frame() {
      const now = performance.now();
      body.moveTo(now);
      room.update(now);
    },
  };
}

const drawn = (room: JoinedRoom) => room.others.object.children.filter(({ visible }) => visible);

test('two pages see each other on any server of node:http, whose own addresses stay as they were', async () => {
  const { url, rooms } = await served();
  expect(await (await fetch(`${url}/hello`)).text()).toBe('mine: /hello');
  expect((await fetch(`${url}/api/rooms`)).status).toBe(200);
  const [ann, ben] = [await joins(url, 'Ann'), await joins(url, 'Ben')];
  await until('each draws the other', () => {
    ann.frame();
    ben.frame();
    return drawn(ann.room).length === 1 && drawn(ben.room).length === 1;
  });
  expect(ann.room.others.people).toEqual([{ seat: 1, name: 'Ben', presence: 'here' }]);
  expect([ann.room.seat, ben.room.seat]).toEqual([0, 1]);
  expect(rooms.census).toMatchObject({ rooms: 1, players: 2 });

  // Ann's hand in Ben's page is where an actor's hand was a moment ago.
  let nearest = Number.POSITIVE_INFINITY;
  const trail: Vector3[] = [];
  await until('the hand is where it was', () => {
    ann.frame();
    ben.frame();
    const { x, y, z } = ann.body.pose!.leftHand!.position;
    trail.push(new Vector3(x, y, z));
    const [body] = drawn(ben.room);
    body!.updateWorldMatrix(true, true);
    body!.traverse((node) => {
      if (!/left.*hand/i.test(node.name)) return;
      const at = node.getWorldPosition(new Vector3());
      for (const place of trail.slice(-40)) nearest = Math.min(nearest, distance(at, place));
    });
    return trail.length > 60 && nearest < 0.01;
  });

  ben.room.leave();
  await until('Ben is gone', () => {
    ann.frame();
    return drawn(ann.room).length === 0 && ann.room.others.people.length === 0;
  });
  expect(ann.room.others.object.children).toHaveLength(0);
});

test('a reload keeps the place, and nobody is there twice', async () => {
  const { url } = await served();
  const tab = storage();
  const ann = await joins(url, 'Ann', { storage: tab });
  const ben = await joins(url, 'Ben');
  const again = await joins(url, 'Ann', { storage: tab });
  expect(again.room.seat).toBe(ann.room.seat);
  await until('the page before has ended', () => {
    for (const page of [ann, ben, again]) page.frame();
    return ann.room.status.phase === 'ended' && drawn(ben.room).length === 1;
  });
  expect(ann.room.status.reason).toBe('replaced');
  expect(ben.room.others.people.map(({ name }) => name)).toEqual(['Ann']);
});

test('an avatar that one page brings is drawn by the others, from the server', async () => {
  const { url } = await served();
  const file = new Blob([new Uint8Array(await mannequinFile)]);
  const ann = await joins(url, 'Ann', { avatarFile: file });
  const { avatar: _, ...ben } = await joins(url, 'Ben', { avatar: undefined } as never);
  await until('Ann is drawn', () => {
    ann.frame();
    ben.frame();
    return drawn(ben.room).length === 1;
  });
});

test('who has no body watches', async () => {
  const { url } = await served();
  const ann = await joins(url, 'Ann');
  const watcher = await joins(url, 'Zoe', { body: null });
  await until('the watcher sees Ann', () => {
    ann.frame();
    watcher.frame();
    return drawn(watcher.room).length === 1;
  });
  expect(watcher.room.seat).toBeNull();
  expect(ann.room.others.people).toEqual([]);
});

test('below a path, and for pages of other origins that are named', async () => {
  const { url } = await served({ path: '/bodies', origins: ['https://here.example'] });
  expect(await (await fetch(`${url}/api/rooms`)).text()).toBe('mine: /api/rooms');
  const asked = (origin: string) =>
    fetch(`${url}/bodies/api/rooms/token`, {
      method: 'POST',
      headers: { origin, 'content-type': 'application/json' },
      body: JSON.stringify({ room: 'lobby', kind: 'people' }),
    });
  const [named, other] = [await asked('https://here.example'), await asked('https://elsewhere.example')];
  expect([named.status, named.headers.get('access-control-allow-origin')]).toEqual([200, 'https://here.example']);
  expect([other.status, other.headers.get('access-control-allow-origin')]).toEqual([403, null]);
  const preflight = await fetch(`${url}/bodies/api/rooms/token`, {
    method: 'OPTIONS',
    headers: { origin: 'https://here.example' },
  });
  expect(preflight.headers.get('access-control-allow-methods')).toContain('POST');
  const room = await joinRoom(`${url}/bodies`, { name: 'Ann', body: solvedActor(), storage: null });
  expect(room.seat).toBe(0);
  room.leave();
});

test('a room that cannot be joined is refused with a sentence', async () => {
  const { url } = await served();
  const join = (address: string, room: string) => joinRoom(address, { name: 'Ann', body: null, room, storage: null });
  await expect(join(url, 'No Such Name')).rejects.toThrow(/expected lower-case letters/);
  await expect(join('http://127.0.0.1:9', 'lobby')).rejects.toThrow(/"lobby" at http:\/\/127.0.0.1:9 cannot be joined/);
  expect(() => attachRooms(createServer(), { secret: 'short' })).toThrow(/32 characters/);
  expect(() => attachRooms(createServer(), { path: 'bodies/' })).toThrow(/like '\/bodies'/);
});
