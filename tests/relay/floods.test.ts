import { expect, onTestFinished, test } from 'vitest';
import type { WebSocket } from 'ws';
import { lobbyNamespace } from '../../src/relay/lobby/lobby-publisher';
import { joinMessage } from '../rooms/room/test-room';
import { sharedServer } from '../server/server-child';
import { type rawGuest, until } from './running-relay';
import { guestOfTest, relayOfTest, socketOfTest } from './until-finished';

/** More than any connection may send at once, by far. */
const frames = 2000;

const relay = sharedServer();

/** Returns how many were thrown out for this reason. */
async function kicks(url: string, reason: string): Promise<number> {
  const metrics = await (await fetch(`${url}/metrics`)).text();
  return Number(new RegExp(`^threepoint_kicks_total\\{reason="${reason}"\\} (\\d+)$`, 'm').exec(metrics)?.[1] ?? 0);
}

/** A connection of a page that shows no pass: it receives the list of rooms and has no place in any. */
async function stranger(url: string): Promise<WebSocket> {
  const socket = socketOfTest(url);
  await new Promise<void>((resolve) => {
    socket.on('message', (received: Buffer) => {
      const text = received.toString();
      if (text[0] === '0') socket.send('40["/lobby"]');
      if (text.startsWith('40')) resolve();
    });
  });
  return socket;
}

test.each<[what: string, send: (socket: WebSocket) => void]>([
  ['acknowledgements to the lobby', (socket) => socket.send(`43["/lobby",[${JSON.stringify('x'.repeat(3900))}],1]`)],
  ['answers to pings that no one sent', (socket) => socket.send('3')],
  ['pings of WebSockets', (socket) => socket.ping()],
  ['pongs of WebSockets', (socket) => socket.pong()],
])('a stranger who floods the relay with %s is disconnected; a guest beside them is served', async (_, send) => {
  const before = await kicks(relay.url, 'flood');
  const guest = await guestOfTest(relay.url, 'beside');
  const socket = await stranger(relay.url);
  let closed = false;
  socket.on('close', () => {
    closed = true;
  });
  for (let i = 0; i < frames; i++) send(socket);
  await until('the end of the flood', () => closed, 5);
  guest.say({ type: 'ping', sent: 0 });
  await until('the answer to another', () => guest.heard.some(({ type }) => type === 'pong'));
  expect(guest.closedAt).toBeNull();
  expect(await kicks(relay.url, 'flood')).toBe(before + 1);
});

/** Returns what a guest has received about the second seat. */
const seatsOf = (heard: Awaited<ReturnType<typeof rawGuest>>['heard']) =>
  heard.flatMap((message) => (message.type === 'seat' && message.seat === 1 && message.info ? [message.info] : []));

test('a guest whose packets are none that the rooms count is told that it misbehaves', async () => {
  const guest = await guestOfTest(relay.url, 'acknowledging');
  const { engine } = guest.socket.io;
  for (let i = 0; i < frames; i++) engine.write('3["/",[],1]');
  await until('the end of the flood', () => guest.closedAt !== null, 5);
  expect(guest.heard.at(-1)).toEqual({ type: 'farewell', reason: 'misbehaved' });
});

test('a guest who joins a thousand times a second is disconnected, known by the first name', async () => {
  const witness = await guestOfTest(relay.url, 'names');
  const guest = await guestOfTest(relay.url, 'names');
  const started = performance.now();
  for (let i = 0; i < 250; i++) guest.say(joinMessage({ name: `<b>${i}</b>` }));
  await until('the end of the one with many names', () => guest.closedAt !== null, 5);
  expect(performance.now() - started).toBeLessThan(1000);
  expect(guest.heard.at(-1)).toEqual({ type: 'farewell', reason: 'misbehaved' });
  await until('the witness to know', () => seatsOf(witness.heard).at(-1)?.[4] === 2);
  expect(new Set(seatsOf(witness.heard).map(([name]) => name))).toEqual(new Set(['raw']));
});

test('a guest who has left the rooms and floods the relay is thrown out too', async () => {
  const guest = await guestOfTest(relay.url, 'leaving');
  const { engine } = guest.socket.io;
  engine.write('1["/"]');
  for (let i = 0; i < frames; i++) engine.write('3["/",[],1]');
  await until('the end of the flood', () => guest.closedAt !== null, 5);
});

/** What a fleet with some hundred rooms sends of them. */
const longList = Array.from({ length: 600 }, (_, i) => ({ room: `a-room-of-the-fleet-${i}`, kind: 'ball', free: 3 }));

test('a listener of the lobby who answers pings and reads nothing is thrown out', async () => {
  // In this process: only the lobby of a large fleet sends so much.
  const inProcess = await relayOfTest();
  const guest = await guestOfTest(inProcess.url, 'beside');
  const socket = await stranger(inProcess.url);
  socket.pause();
  const answering = setInterval(() => socket.send('3'), 500);
  onTestFinished(() => clearInterval(answering));
  const hall = inProcess.relay.io.of(lobbyNamespace);
  const changing = setInterval(() => hall.local.emit('node', { node: 'one', rooms: longList }), 5);
  onTestFinished(() => clearInterval(changing));
  await until('the end of the one who reads nothing', () => inProcess.relay.census.sockets === 1, 15);
  expect(guest.closedAt).toBeNull();
  expect(await kicks(inProcess.url, 'slow')).toBe(1);
});

test('a connection gets the list of rooms once: a second request ends it', async () => {
  const socket = await stranger(relay.url);
  const ended = new Promise((resolve) => socket.once('close', resolve));
  socket.send('41["/lobby"]');
  // The pong comes after the relay has taken in that the lobby was left.
  socket.ping();
  await new Promise((resolve) => socket.once('pong', resolve));
  const lists: string[] = [];
  socket.on('message', (received: Buffer) => lists.push(received.toString()));
  const asked = performance.now();
  socket.send('40["/lobby"]');
  await ended;
  // A connection that says nothing is ended after seven seconds: this was not.
  expect(performance.now() - asked).toBeLessThan(3000);
  expect(lists.filter((text) => text.includes('"rooms"'))).toEqual([]);
});
