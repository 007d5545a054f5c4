import { RoomTokens } from 'threepoint-relay';
import { createRoomPass } from 'threepoint-rooms/internal';
import { afterEach, beforeEach, describe, expect, test } from 'vitest';
import { scheduleFor } from '../../../src/study/model/plan/schedule';
import { createStudySeats } from '../../../src/study/server/routes/seats';
import { rawGuest, rawLobby, rawSocket, tokenFor, until } from '../../relay/running-relay';
import { reportFigures } from '../../reliability/report-figures';
import { type StartedServer, startServer, testSecret } from '../../server/started-server';
import { paperPlan } from '../model/studies';

const plan = paperPlan();
const tokens = new RoomTokens(testSecret, () => Date.now() / 1000);
const seats = createStudySeats(testSecret, (pass) => tokens.sign(pass));
const step = 'ball/1/trial-1';
const trial = { step, run: 1 };
/** The group of P01, in the order of their seats. */
const group = scheduleFor(plan, 'P01').groups.ball?.members as readonly string[];

let server: StartedServer;
beforeEach(async () => {
  server = await startServer();
});
afterEach(() => server.kill());

const census = async () => (await fetch(`${server.url}/healthz`)).json();

const seatOf = (participant: string, watching = false) => seats.sign(plan, participant, trial, watching);

async function sitDown(participant: string, watching = false) {
  const { room, token } = await seatOf(participant, watching);
  return { room, guest: await rawGuest(server.url, room, token) };
}

const welcomeOf = ({ guest }: Awaited<ReturnType<typeof sitDown>>) =>
  guest.heard.find((message) => message.type === 'welcome');

/** Returns what the lobby's socket sends to a stranger. */
const toldByLobby = () =>
  new Promise<string>((resolve) => {
    let told = '';
    const socket = rawLobby(server.url);
    socket.on('rooms', (list) => {
      told += JSON.stringify(list);
    });
    socket.on('node', (list) => {
      told += JSON.stringify(list);
      if (!told.includes('meadow')) return;
      socket.disconnect();
      resolve(told);
    });
  });

const post = (path: string, body: unknown) =>
  fetch(`${server.url}${path}`, {
    method: 'POST',
    headers: { 'content-type': 'application/json' },
    body: JSON.stringify(body),
  });

describe('the room of a trial', () => {
  test('is in no list, neither the lobby’s nor the socket’s, and attracts no match', async () => {
    const lobby = toldByLobby();
    const { guest } = await sitDown('P01');
    const stranger = await rawGuest(server.url, 'meadow');
    const told = await lobby;
    await expect.poll(async () => (await fetch(`${server.url}/api/rooms`)).text()).toContain('meadow');
    const listed = await (await fetch(`${server.url}/api/rooms`)).text();
    const matched = await (await post('/api/rooms/match', { kind: 'ball' })).text();
    expect(await census()).toMatchObject({ rooms: 2, players: 2 });
    for (const text of [told, listed, matched]) expect(text).not.toContain('study');
    reportFigures('study-rooms', { 'lists that show the room of a trial': '0 of 3' });
    guest.socket.disconnect();
    stranger.socket.disconnect();
  });

  test('seats each participant of the group under their own code, whatever the page asks', async () => {
    const people = [];
    for (const participant of group.toReversed()) people.unshift(await sitDown(participant));
    expect(people.map((one) => welcomeOf(one)?.seat)).toEqual([0, 1, 2]);
    const last = people[0]?.guest.heard.findLast((message) => message.type === 'seat' || message.type === 'welcome');
    expect(JSON.stringify([welcomeOf(people[0] as never), last])).toContain(group[0]);
    expect(JSON.stringify(people.map(welcomeOf))).not.toContain('raw');
    const [first] = people;
    first?.guest.say({ type: 'sit', seat: null });
    first?.guest.say({ type: 'ping', sent: 1 });
    await until('the answer', () => first?.guest.heard.some(({ type }) => type === 'pong') === true);
    expect(first?.guest.heard.some(({ type }) => type === 'seated')).toBe(false);
    for (const { guest } of people) guest.socket.disconnect();
  });

  test('has no seat for a stranger: nobody signs a pass, and no other pass opens it', async () => {
    const { room, guest } = await sitDown('P01');
    let refused = 0;
    const attempts: unknown[] = [
      { room, kind: 'ball' },
      { room: room.toUpperCase(), kind: 'ball' },
      { room, kind: 'counting' },
      { room, kind: 'ball', token: (await seatOf('P01')).token },
      { room: 'meadow', kind: 'ball', assigned: { seat: 1, name: 'P02' } },
    ];
    for (const attempt of attempts) {
      const { status } = await post('/api/rooms/token', attempt);
      if (status === 400) refused += 1;
    }
    expect(refused).toBe(attempts.length);
    // Signed by this server, for a name of this kind, but without a seat.
    const forged = await tokens.sign({ identity: 'me', room, kind: 'ball', terms: {}, assigned: null });
    const answer = await new Promise<string>((resolve) => {
      const socket = rawSocket(server.url, forged, room);
      socket.on('connect', () => resolve('let in'));
      socket.on('connect_error', (error) => resolve(error.message));
    });
    expect(answer).toBe('refused');
    const elsewhere = await rawGuest(server.url, room, await tokenFor(server.url, 'meadow'));
    expect(elsewhere.heard.find((message) => message.type === 'welcome')).toMatchObject({ room: 'meadow' });
    expect(await census()).toMatchObject({ rooms: 2, players: 2, sockets: 2 });
    reportFigures('study-rooms', { 'seats that a stranger got': `0 of ${attempts.length + 2} attempts` });
    for (const { socket } of [guest, elsewhere]) socket.disconnect();
  });

  test('is watched with the experimenter’s pass alone, which takes no seat', async () => {
    const watching = await sitDown('P01', true);
    expect(welcomeOf(watching)?.seat).toBeNull();
    watching.guest.say({ type: 'sit', seat: 1 });
    watching.guest.say({ type: 'ping', sent: 1 });
    await until('the answer', () => watching.guest.heard.some(({ type }) => type === 'pong'));
    expect(await census()).toMatchObject({ rooms: 1, players: 0, sockets: 1 });
    watching.guest.socket.disconnect();
  });

  test('is the same one for the group and another one for other groups, steps and runs', async () => {
    const others = scheduleFor(plan, 'P01').groups.ball?.number;
    const stranger = plan.participants;
    const far = Array.from({ length: stranger }, (_, i) => `P${String(i + 1).padStart(2, '0')}`).find(
      (name) => scheduleFor(plan, name).groups.ball?.number !== others,
    ) as string;
    const rooms = await Promise.all(group.map(async (name) => (await seatOf(name)).room));
    expect(new Set(rooms).size).toBe(1);
    const different = await Promise.all([
      seatOf(far),
      seats.sign(plan, 'P01', { step, run: 2 }, false),
      seats.sign(plan, 'P01', { step: 'ball/2/trial-1', run: 1 }, false),
      createStudySeats(`${testSecret}2`, (pass) => tokens.sign(pass)).sign(plan, 'P01', trial, false),
    ]);
    expect(new Set([...rooms, ...different.map(({ room }) => room)]).size).toBe(5);
    for (const { room } of different) expect(room).toMatch(/^study\.[0-9a-f]{24}$/);
  });

  test('is none where a participant plays alone', async () => {
    await expect(seats.sign(plan, 'P01', { step: 'archery/1/trial-1', run: 1 }, false)).rejects.toThrow(
      'expected a step that P01 plays with others',
    );
    await expect(seats.sign(plan, 'P01', { step: 'ball/1/rest', run: 1 }, false)).rejects.toThrow('step');
  });
});

test('a person who comes back with their pass has their seat again', async () => {
  const first = await sitDown('P02');
  const again = await sitDown('P02');
  await until('the first sent away', () => first.guest.closedAt !== null);
  expect(first.guest.heard.at(-1)).toEqual({ type: 'farewell', reason: 'replaced' });
  expect(welcomeOf(again)?.seat).toBe(scheduleFor(plan, 'P02').groups.ball?.members.indexOf('P02'));
  again.guest.socket.disconnect();
});

test('rooms of everyone else are as open as they were', async () => {
  const pass = createRoomPass(server.url, 'study-group-of-friends', 'ball');
  const guest = await rawGuest(server.url, 'study-group-of-friends', await pass.token(false));
  guest.say({ type: 'sit', seat: 2 });
  await until('the seat', () => guest.heard.some(({ type }) => type === 'seated'));
  guest.socket.disconnect();
});
