import { createHash, randomBytes } from 'node:crypto';
import { request as httpRequest } from 'node:http';
import { maxAvatarBytes } from 'threepoint/core';
import { createAvatarExchange, createRoomPass } from 'threepoint-rooms/internal';
import { afterEach, beforeEach, describe, expect, test } from 'vitest';
import { reportFigures } from '../reliability/report-figures';
import { paperPlan } from '../study/model/studies';
import { studySeats } from '../study/server/running-studies';
import { changed } from '../threepoint/avatar/glb';
import { type RunningRelay, startRelay, tokenFor, until } from './running-relay';
import { guestOfTest } from './until-finished';

const megabyte = 2 ** 20;
let relay: RunningRelay;
// What is stored or counted in one test is no matter of the next.
beforeEach(async () => {
  relay = await startRelay({ THREEPOINT_AVATAR_MEGABYTES: '8' });
});

afterEach(() => relay.close());

const hashOf = (bytes: Uint8Array): string => createHash('sha256').update(bytes).digest('base64url');
/** A body of our own, made another file by so many bytes without meaning at its end. */
const file = (more = 0): Uint8Array => new Uint8Array(changed(() => undefined, undefined, randomBytes(4 + more)));

/** A person on a seat, and their way to the store. */
async function seated(room: string) {
  const token = await tokenFor(relay.url, room);
  const guest = await guestOfTest(relay.url, room, token);
  const ask = (method: string, hash: string, bytes?: Uint8Array, headers: Record<string, string> = {}) =>
    fetch(`${relay.url}/api/avatars${hash && `/${hash}`}?room=${room}`, {
      method,
      headers: { authorization: `Bearer ${token}`, ...(bytes && { 'content-type': 'model/gltf-binary' }), ...headers },
      ...(bytes && { body: bytes as Uint8Array<ArrayBuffer> }),
    });
  return { ...guest, token, ask, store: (bytes: Uint8Array) => ask('PUT', hashOf(bytes), bytes) };
}

const sentence = async (response: Response): Promise<string> => ((await response.json()) as { error: string }).error;

describe('an avatar in the store', () => {
  test('comes to the others of the room as brought, as a file that no browser runs', async () => {
    const [ann, ben] = [await seated('meadow'), await seated('meadow')];
    const bytes = file();
    expect((await ann.store(bytes)).status).toBe(204);
    const answer = await ben.ask('GET', hashOf(bytes));
    expect(answer.status).toBe(200);
    expect(hashOf(new Uint8Array(await answer.arrayBuffer()))).toBe(hashOf(bytes));
    expect(Object.fromEntries(answer.headers)).toMatchObject({
      'content-type': 'model/gltf-binary',
      'x-content-type-options': 'nosniff',
      'content-disposition': 'attachment; filename="avatar.glb"',
      'content-security-policy': "default-src 'none'; sandbox",
      'cross-origin-resource-policy': 'same-origin',
      'cache-control': 'no-store',
    });
    expect(await (await ann.ask('GET', '')).json()).toMatchObject({ yours: hashOf(bytes), elsewhere: null });
    expect(await (await ben.ask('GET', '')).json()).toMatchObject({ yours: null });
  });

  test('is known to its room alone, and to no one without a pass to that room', async () => {
    const [ann, eve] = [await seated('birch'), await seated('cedar')];
    const bytes = file();
    await ann.store(bytes);
    const hash = hashOf(bytes);
    expect((await eve.ask('GET', hash)).status).toBe(404);
    const asked = (token: string, room: string) =>
      fetch(`${relay.url}/api/avatars/${hash}?room=${room}`, { headers: { authorization: `Bearer ${token}` } });
    expect((await asked(eve.token, 'birch')).status).toBe(403);
    expect((await asked('nothing', 'birch')).status).toBe(401);
    expect((await fetch(`${relay.url}/api/avatars/${hash}?room=birch`)).status).toBe(401);
  });

  test('remains its owner’s when another wears its hash: it is deleted with the owner’s next one', async () => {
    const [ann, ben] = [await seated('copies'), await seated('copies')];
    const hash = hashOf(file());
    const bytes = file();
    const worn = hashOf(bytes);
    await ann.store(bytes);
    ann.say({ type: 'wear', avatar: worn });
    ben.say({ type: 'wear', avatar: worn });
    const avatarOnSeat = (seat: number) =>
      ann.heard
        .flatMap((message) => (message.type === 'seat' && message.seat === seat ? message.info?.[6] : []))
        .at(-1);
    await until('both wear it', () => [0, 1].every((seat) => avatarOnSeat(seat) === worn));
    expect(await (await ben.ask('GET', '')).json()).toMatchObject({ yours: null });
    await expect.poll(() => relay.relay.avatars.count).toBe(1);
    relay.relay.avatars.sweep();
    ann.say({ type: 'wear', avatar: hash });
    await expect.poll(async () => (await ben.ask('GET', worn)).status, { timeout: 5000 }).toBe(404);
    expect(relay.relay.avatars.count).toBe(0);
  });

  test('goes with its owner’s seat, and with the room', { tags: ['full'] }, async () => {
    const [ann, ben] = [await seated('fir'), await seated('fir')];
    const bytes = file();
    const hash = hashOf(bytes);
    await ann.store(bytes);
    ann.say({ type: 'wear', avatar: hash });
    await until('ben to hear of it', () => ben.heard.some((m) => m.type === 'seat' && m.info?.[6] === hash));
    expect((await ben.ask('GET', hash)).status).toBe(200);
    ann.say({ type: 'leave' });
    await until('the file gone', () => relay.relay.avatars.get('fir', hash) === null);
    expect((await ben.ask('GET', hash)).status).toBe(404);

    await ben.store(bytes);
    ben.say({ type: 'wear', avatar: hash });
    ben.say({ type: 'leave' });
    await until('the room gone', () => relay.relay.rooms.get('fir') === undefined, 20);
    await until('the file gone with it', () => relay.relay.avatars.get('fir', hash) === null);
  });

  test('goes when its owner has another one on, and the next takes its place', async () => {
    const [ann, ben] = [await seated('elm'), await seated('elm')];
    const wears = async (avatar: string) => {
      const before = ben.heard.length;
      ann.say({ type: 'wear', avatar });
      await until('the room to know', () =>
        ben.heard.slice(before).some((m) => m.type === 'seat' && m.info?.[6] === avatar),
      );
    };
    const [first, second] = [file(), file()];
    await ann.store(first);
    await wears(hashOf(first));
    await ann.store(second);
    expect(relay.relay.avatars.get('elm', hashOf(first))).toBeNull();
    // The store is swept at any moment: between a file and word of it, too.
    relay.relay.avatars.sweep();
    await wears(hashOf(second));
    relay.relay.avatars.sweep();
    expect((await ann.ask('GET', hashOf(second))).status).toBe(200);
    await wears(hashOf(first));
    await until('the other file gone', () => relay.relay.avatars.get('elm', hashOf(second)) === null);
  });
});

/** What no store takes, and what is said of it. */
const refused: readonly (readonly [string, Uint8Array, string | null, number, RegExp])[] = [
  ['a file that is another than its name says', file(), hashOf(file()), 422, /differs from its name/],
  ['a picture with a script in it', Buffer.from('<svg onload="alert(1)"/>'.repeat(3)), null, 422, /not a VRM or GLB/],
  ['a web page', Buffer.from('<!doctype html><script>alert(1)</script>'), null, 422, /not a VRM or GLB/],
  ['half a body', file().subarray(0, 9000), null, 422, /not a VRM or GLB/],
  ['nothing', new Uint8Array(), null, 422, /not a VRM or GLB/],
  ['more than 20 MB', new Uint8Array(maxAvatarBytes + 1), null, 413, /larger than 20971520 bytes/],
  ['more than there is place for', new Uint8Array(9 * megabyte), null, 507, /no space/],
];

describe('the store takes no', () => {
  test.each(refused)('%s', async (what, bytes, name, status, words) => {
    const eve = await seated(`no-${refused.findIndex(([other]) => other === what)}`);
    const answer = await eve.ask('PUT', name ?? hashOf(bytes), bytes);
    expect(answer.status).toBe(status);
    expect(await sentence(answer)).toMatch(words);
    expect((await eve.ask('GET', name ?? hashOf(bytes))).status).toBe(404);
  });

  test('file of another kind, name that is no hash, or body without a length', async () => {
    const eve = await seated('no-kind');
    const bytes = file();
    expect((await eve.ask('PUT', hashOf(bytes), bytes, { 'content-type': 'text/html' })).status).toBe(415);
    expect((await eve.ask('PUT', 'bear.vrm', bytes)).status).toBe(400);
    expect((await eve.ask('GET', '..%2f..%2fetc%2fpasswd')).status).toBe(400);
    const chunked = await new Promise<number>((resolve, reject) => {
      const sending = httpRequest(`${relay.url}/api/avatars/${hashOf(bytes)}?room=no-kind`, {
        method: 'PUT',
        headers: {
          authorization: `Bearer ${eve.token}`,
          'content-type': 'model/gltf-binary',
          'transfer-encoding': 'chunked',
        },
      });
      sending.on('response', (answer) => resolve(answer.resume().statusCode ?? 0)).on('error', reject);
      sending.write('glTF');
    });
    expect(chunked).toBe(411);
  });

  test('file of watchers, of participants in a study, or of holders of a lost seat', async () => {
    const bytes = file();
    const eve = await seated('no-seat');
    eve.say({ type: 'sit', seat: null });
    await until('the seat given up', () => eve.heard.some(({ type }) => type === 'seated'));
    const watching = await eve.store(bytes);
    expect(watching.status).toBe(403);
    expect(await sentence(watching)).toMatch(/on a seat of the room/);
    const { room, token } = await studySeats.sign(paperPlan(), 'P01', { step: 'ball/1/trial-1', run: 1 }, false);
    await guestOfTest(relay.url, room, token);
    const inStudy = await fetch(`${relay.url}/api/avatars/${hashOf(bytes)}?room=${room}`, {
      method: 'PUT',
      headers: { authorization: `Bearer ${token}`, 'content-type': 'model/gltf-binary' },
      body: bytes as Uint8Array<ArrayBuffer>,
    });
    expect(inStudy.status).toBe(403);
    expect(await sentence(inStudy)).toMatch(/rooms of a study/);
    expect(relay.relay.avatars.count).toBe(0);
  });

  test('file beyond a person’s four a minute, and all files together stay within their bound', async () => {
    const eve = await seated('often');
    const statuses = [];
    for (let i = 0; i < 6; i++) statuses.push((await eve.store(file(2 * megabyte))).status);
    expect(statuses).toEqual([204, 204, 204, 204, 429, 429]);
    const many = await Promise.all(['a', 'b', 'c'].map((name) => seated(`full-${name}`)));
    const answers = await Promise.all(many.map((person) => person.store(file(2 * megabyte))));
    expect(answers.map(({ status }) => status).toSorted()).toEqual([204, 204, 507]);
    expect(relay.relay.avatars.bytes).toBeLessThanOrEqual(8 * megabyte);
  });
});

test('seats in many rooms fill only the share of their address: others find theirs', async () => {
  await relay.close();
  relay = await startRelay({ THREEPOINT_AVATAR_MEGABYTES: '96', THREEPOINT_TRUST_PROXY: '1' });
  const upload = async (room: string, address: string, bytes: Uint8Array) => {
    const person = await seated(room);
    const answer = await person.ask('PUT', hashOf(bytes), bytes, { 'x-forwarded-for': address });
    return answer.ok ? answer.status : `${answer.status}: ${await sentence(answer)}`;
  };
  const [eve, ann] = ['203.0.113.1', '203.0.113.2'];
  const large = file(8 * megabyte);
  const eves = [];
  for (const room of ['one', 'two', 'three', 'four']) eves.push(await upload(room, eve, large));
  const crowded = '507: the avatars from your network use all their space on this server; try again later';
  expect(eves).toEqual([204, 204, crowded, crowded]);
  const anns = await upload('one', ann, large);
  expect(anns).toBe(204);
  reportFigures('avatar-store', {
    'stored of four files of 8 MB from one address, of 96 MB': eves.filter((status) => status === 204).length,
    'answer to another address afterwards': anns,
    'kept in all': `${Math.round(relay.relay.avatars.bytes / megabyte)} MB`,
  });
});

test('an upload that never ends blocks no other and is forgotten with its connection', async () => {
  const eve = await seated('endless');
  const bytes = file();
  const sending = httpRequest(`${relay.url}/api/avatars/${hashOf(bytes)}?room=endless`, {
    method: 'PUT',
    headers: {
      authorization: `Bearer ${eve.token}`,
      'content-type': 'model/gltf-binary',
      'content-length': bytes.length,
    },
  });
  sending.on('error', () => undefined).write(bytes.subarray(0, 1000));
  await until('it to have begun', () => relay.relay.avatars.bytes >= bytes.length);
  expect((await eve.store(bytes)).status).toBe(409);
  const ann = await seated('endless');
  expect((await ann.store(bytes)).status).toBe(204);
  sending.destroy();
  await until('its place to be free', () => relay.relay.avatars.bytes === bytes.length);
});

test('a page learns what it needs by its pass, or by a new one after expiry', async () => {
  const ann = await seated('exchange');
  let asked = 0;
  const pass = {
    token: async (afresh: boolean) => {
      asked += 1;
      return afresh ? ann.token : 'expired';
    },
  };
  const exchange = createAvatarExchange(relay.url, 'exchange', pass);
  const bytes = file();
  await exchange.store(hashOf(bytes), new Blob([bytes as Uint8Array<ArrayBuffer>]));
  expect(asked).toBe(2);
  expect(await exchange.terms()).toEqual({ maxBytes: 8 * megabyte, elsewhere: null, yours: hashOf(bytes) });
  const stranger = createAvatarExchange(relay.url, 'exchange', createRoomPass(relay.url, 'exchange', 'ball'));
  await expect(stranger.store(hashOf(bytes), new Blob([bytes as Uint8Array<ArrayBuffer>]))).rejects.toThrow(
    'only people on a seat of the room may upload avatars',
  );
});
