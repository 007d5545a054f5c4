import { once } from 'node:events';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { type AddressInfo, connect } from 'node:net';
import { Group, Vector3 } from 'three';
import { distance } from 'threepoint/math';
import { type Avatar, loadAvatar } from 'threepoint/three';
import { type JoinedRoom, type JoinRoomOptions, joinRoom } from 'threepoint-rooms/three';
import { beforeEach, expect, onTestFinished, test, vi } from 'vitest';
import { attachRooms } from '../../src/relay/attach-rooms';
import { relayConfigurationFrom } from '../../src/relay/settings/relay-configuration';
import { stubFileFetch } from '../rooms/peers/file-fetch';
import { solvedActor } from '../rooms/peers/solved-actor';
import { countingClientPolicy, countingKind, countingRoomKind } from '../rooms/room/counting-game';
import { ask } from '../server/running-server';
import { changed } from '../threepoint/avatar/glb';
import { until } from './running-relay';
import { servedRooms } from './served-rooms';

const mannequinFile = readFile('public/avatars/mannequin.vrm');

beforeEach(stubFileFetch);

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

test('two pages meet on any server of node:http, whose own addresses stay as they were', async () => {
  const { url, rooms } = await servedRooms();
  expect(await (await fetch(`${url}/hello`)).text()).toBe('mine: /hello');
  expect((await fetch(`${url}/api/rooms`)).status).toBe(200);
  // In one real place, where the floors of both have one origin.
  const [ann, ben] = [await joins(url, 'Ann', { circle: 0 }), await joins(url, 'Ben', { circle: 0 })];
  await until('each draws the other', () => {
    ann.frame();
    ben.frame();
    const seen = drawn(ann.room).length === 1 && drawn(ben.room).length === 1;
    return seen && ann.room.others.people[0]?.presence === 'here';
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
});

test('a reload keeps the place, and nobody is there twice', async () => {
  const { url } = await servedRooms();
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
  const { url } = await servedRooms();
  const file = changed((json) => {
    for (const node of json.nodes) if (node.mesh !== undefined) node.name = "Ann's";
  });
  const ann = await joins(url, 'Ann', { avatarFile: new Blob([file]) });
  const { avatar: _, ...ben } = await joins(url, 'Ben', { avatar: undefined } as never);
  await until('Ann is drawn in her avatar', () => {
    ann.frame();
    ben.frame();
    return drawn(ben.room).some((body) => body.getObjectByName("Ann's") !== undefined);
  });
});

/** A file that the wearer may open, and that costs the others too much. */
const morphing = () =>
  changed((json) => {
    const [primitive] = json.meshes[0]?.primitives ?? [];
    if (primitive)
      primitive.targets = Array.from({ length: 1500 }, () => ({ POSITION: primitive.attributes.POSITION! }));
  });

/** A file whose bones are their own parents. */
const circular = () =>
  changed((json) => {
    const child = json.nodes[json.nodes[0]?.children?.[0] ?? 1];
    if (child) child.children = [0];
  });

test.each<[what: string, file: () => ArrayBuffer, sentence: RegExp]>([
  [
    'costs more than that of a stranger may',
    morphing,
    /avatar of Ann could not be shown.* morph targets; an avatar may/,
  ],
  ['is malformed', circular, /avatar of Ann could not be shown.*not valid glTF/],
])(
  'an avatar of another person that %s is refused with a sentence; the mannequin is drawn',
  async (_, file, sentence) => {
    const warnings = vi.spyOn(console, 'warn').mockReturnValue();
    onTestFinished(() => warnings.mockRestore());
    const { url } = await servedRooms();
    const ann = await joins(url, 'Ann', { avatarFile: new Blob([file()]) });
    const ben = await joins(url, 'Ben', { avatar: undefined } as never);
    await until('the refusal', () => {
      ann.frame();
      ben.frame();
      return warnings.mock.calls.some(([text]) => sentence.test(String(text)));
    });
    ann.frame();
    ben.frame();
    expect(drawn(ben.room)).toHaveLength(1);
    expect(ben.room.others.object.children).toHaveLength(1);
  },
);

test('a page of a game acts, gets its events, and draws the others on their floors', async () => {
  const { url } = await servedRooms({ games: new Map([[countingKind, countingRoomKind(2)]]) });
  const joinGame = async (name: string) => {
    const body = solvedActor();
    const room = await joinRoom(url, { name, body, game: countingClientPolicy, storage: null });
    onTestFinished(() => room.leave());
    room.client.connection?.setReady(true);
    return { room, body };
  };
  const [ann, ben] = [await joinGame('Ann'), await joinGame('Ben')];
  const events: unknown[] = [];
  let nextCount = 0;
  await until('a count by Ben, who sees Ann', () => {
    const now = performance.now();
    for (const { room, body } of [ann, ben]) {
      body.moveTo(now);
      events.push(...room.update(now).events);
    }
    if (now > nextCount) {
      nextCount = now + 300;
      ben.room.client.connection?.sendAction({ type: 'count', to: 1 });
    }
    // A count before the round runs is refused.
    const counted = events.some((event) => (event as { type: string }).type === 'counted');
    return counted && ben.room.others.object.children.some(({ visible }) => visible);
  });
  expect(events).toContainEqual({ type: 'counted', player: 1, total: 1 });
  expect(ben.room.client.people.map(({ id, placement }) => [id, placement.position.y])).toEqual([[0, -1]]);
});

test('far from the origin of the scene people are where the object of the others is', async () => {
  const warnings = vi.spyOn(console, 'warn').mockReturnValue();
  onTestFinished(() => warnings.mockRestore());
  const { url } = await servedRooms();
  const pier = new Group();
  pier.position.set(400, 2, -300);
  pier.rotation.y = 1;
  const floor = new Group();
  pier.add(floor);
  const body = Object.assign(solvedActor(), { avatar: { object: floor } });
  const { room } = await joins(url, 'Ann', { body, circle: 0 });
  const ben = await joins(url, 'Ben', { circle: 0 });
  const frame = () => {
    const now = performance.now();
    body.moveTo(now);
    room.update(now);
    ben.frame();
  };
  frame();
  expect(warnings.mock.calls).toEqual([[expect.stringMatching(/The body is (399|400|401)\.\d m from the origin/)]]);
  pier.add(room.others.object);
  await until('Ben is on the pier', () => {
    frame();
    return drawn(room).length === 1;
  });
  expect(warnings).toHaveBeenCalledOnce();
  expect(distance(drawn(room)[0]!.getWorldPosition(new Vector3()), pier.position)).toBeLessThan(0.01);
});

test('a person without a body watches', async () => {
  const { url } = await servedRooms();
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
  const { url } = await servedRooms({ path: '/bodies', origins: ['https://here.example'] });
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

test.each<[what: string, environment: NodeJS.ProcessEnv | null, named: boolean, other: boolean]>([
  ['without hosts answer under any name', null, true, true],
  ['of an environment answer under the names that it states', { THREEPOINT_HOSTS: 'bodies.example.com' }, true, false],
  ['of an environment without hosts answer under no other name', {}, false, false],
])('rooms %s, to requests and to WebSockets', async (_, environment, named, other) => {
  const { server } = await servedRooms(
    environment ? relayConfigurationFrom({ ...environment, THREEPOINT_LOG_LEVEL: 'silent' }) : {},
  );
  const { port } = server.address() as AddressInfo;
  const statusOf = async (path: string, host: string, headers = '') => {
    const socket = connect(port, '127.0.0.1');
    socket.write(`GET ${path} HTTP/1.1\r\nHost: ${host}\r\n${headers}\r\n`);
    const [answer] = (await once(socket, 'data')) as [Buffer];
    socket.destroy();
    return answer.toString().slice('HTTP/1.1 '.length, 'HTTP/1.1 200'.length);
  };
  const key = `Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: ${Buffer.alloc(16).toString('base64')}\r\n`;
  const upgrade = `Connection: Upgrade\r\nUpgrade: websocket\r\n${key}`;
  for (const [host, answered] of [
    ['bodies.example.com', named],
    ['elsewhere.example.com', other],
  ] as const) {
    expect(await statusOf('/api/rooms', host)).toBe(answered ? '200' : '421');
    expect(await statusOf('/relay/?EIO=4&transport=websocket', host, upgrade)).toBe(answered ? '101' : '421');
  }
});

test('requests with two names of the server reach no room, as requests and as WebSockets', async () => {
  const { server } = await servedRooms();
  const { port } = server.address() as AddressInfo;
  for (const upgrade of ['', 'Connection: Upgrade\r\nUpgrade: websocket\r\n']) {
    const socket = connect(port, '127.0.0.1');
    socket.end(`GET /relay/?EIO=4 HTTP/1.1\r\nHost: localhost\r\nHost: elsewhere.example\r\n${upgrade}\r\n`);
    const [answer] = (await once(socket, 'data')) as [Buffer];
    expect(answer.toString()).toMatch(/^HTTP\/1.1 400 /);
    socket.destroy();
  }
});

test('an offer of another protocol than the rooms’ is answered as a request without one', async () => {
  const { url } = await servedRooms();
  const headers = { connection: 'Upgrade', upgrade: 'h2c' };
  const [own, rooms] = [await ask(url, '/hello', { headers }), await ask(url, '/api/rooms', { headers })];
  expect(own.body.toString()).toBe('mine: /hello');
  expect(JSON.parse(rooms.body.toString())).toEqual({ rooms: [], complete: true });
});

test('people see each other across a circle', async () => {
  const { url } = await servedRooms();
  const [ann, ben] = [await joins(url, 'Ann'), await joins(url, 'Ben')];
  const drawn = new Map<typeof ann, Avatar>();
  const headOf = (person: typeof ann) => {
    const head = drawn.get(person)?.jointPositions().head;
    return head && person.room.others.object.localToWorld(new Vector3().copy(head));
  };
  await until('each sees the other', () => {
    for (const person of [ann, ben]) {
      person.frame();
      void person.avatar.mock.results[0]?.value.then((avatar: Avatar) => drawn.set(person, avatar));
    }
    return headOf(ann) !== undefined && headOf(ben) !== undefined;
  });
  for (const person of [ann, ben]) {
    const { x, z } = headOf(person)!;
    // The actor moves about its origin by less than half a metre.
    expect(Math.hypot(x, z + 3)).toBeLessThan(0.5);
  }
});

test('a room that cannot be joined is refused with a sentence', async () => {
  const { url } = await servedRooms();
  const join = (address: string, room: string) => joinRoom(address, { name: 'Ann', body: null, room, storage: null });
  await expect(join(url, 'No Such Name')).rejects.toThrow(/expected lower-case letters/);
  await expect(join('http://127.0.0.1:9', 'lobby')).rejects.toThrow(/"lobby" at http:\/\/127.0.0.1:9 cannot be joined/);
  expect(() => attachRooms(createServer(), { secret: 'short' })).toThrow(/32 characters/);
  expect(() => attachRooms(createServer(), { path: 'bodies/' })).toThrow(/like '\/bodies'/);
});
