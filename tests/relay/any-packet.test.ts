import { setTimeout as after } from 'node:timers/promises';
import fc from 'fast-check';
import { ballKind } from 'threepoint-games/ball';
import { expect, test } from 'vitest';
import { WebSocket } from 'ws';
import { RoomTokens } from '../../src/relay/access/room-tokens';
import { isNightly } from '../nightly';
import { reportFigures } from '../reliability/report-figures';
import { noPackets } from '../rooms/protocol/no-packets';
import { joinMessage } from '../rooms/room/test-room';
import { forkServer } from '../server/server-child';
import { testSecret } from '../server/started-server';
import { conversations, type WireFrame } from './packets';
import { until } from './running-relay';
import { guestOfTest } from './until-finished';

const atOnce = 20;
const wanted = isNightly ? 100_000 : 2000;
const tokens = new RoomTokens(testSecret, () => Date.now() / 1000);

const joining = JSON.stringify(
  joinMessage({ name: '<img src=x onerror=alert(1)>', voice: { session: 'session-one', muted: false } }),
);

/** The stages that a client reaches before it sends a bad packet. */
const stages = ['stranger', 'lobby', 'guest', 'seated'] as const;

/** Opens a WebSocket, comes as far as `stage`, sends these frames, and resolves once it is over. */
async function converse(url: string, stage: (typeof stages)[number], frames: readonly WireFrame[]): Promise<void> {
  const socket = new WebSocket(`${url.replace('http', 'ws')}/relay/?EIO=4&transport=websocket`);
  // A connection that the relay ends while frames are on their way is no fault.
  socket.on('error', () => undefined);
  const closed = new Promise<void>((resolve) => socket.once('close', () => resolve()));
  const arrived = new Promise<void>((resolve) => {
    socket.on('message', async (received: Buffer) => {
      const said = received.toString();
      if (said.startsWith('0')) {
        if (stage === 'stranger') resolve();
        else if (stage === 'lobby') socket.send('40["/lobby"]');
        else socket.send(`40["/",{"token":"${await tokens.issue('hostile', ballKind)}"}]`);
      } else if (said.startsWith('40')) {
        if (stage === 'seated') socket.send(`42["/",["message",${joining}]]`);
        else resolve();
      } else if (said.includes('"welcome"')) resolve();
    });
  });
  await Promise.race([arrived, closed]);
  for (const frame of frames) socket.send(frame);
  // The answer to this comes after all that the relay has to say to the frames, if it has not ended the connection.
  socket.ping();
  await Promise.race([new Promise((resolve) => socket.once('pong', resolve)), closed, after(5000)]);
  socket.close();
  await Promise.race([closed, after(1000)]);
  socket.terminate();
}

test('a text that is no packet ends the connection that sends it, and nothing else', async () => {
  const relay = await forkServer();
  const witness = await guestOfTest(relay.url, 'hostile');
  for (const packet of noPackets) {
    await Promise.all(stages.map((stage) => converse(relay.url, stage, [`4${packet}`])));
    expect(relay.isAlive(), packet).toBe(true);
  }
  witness.say({ type: 'ping', sent: 0 });
  await until('the answer to another', () => witness.heard.some(({ type }) => type === 'pong'));
  expect(witness.closedAt).toBeNull();
});

test('the relay keeps running and answers the others, whatever a client sends over its WebSocket', {
  tags: ['full'],
  timeout: 1_800_000,
}, async () => {
  // Budgets would keep most of it from the rooms.
  const relay = await forkServer({ THREEPOINT_EVENTS_PER_SECOND: '200', THREEPOINT_POSES_PER_SECOND: '200' });
  const witness = await guestOfTest(relay.url, 'hostile');
  const pongs = () => witness.heard.filter(({ type }) => type === 'pong').length;
  const waits: number[] = [];
  let sent = 0;
  let talks = 0;
  for (let seed = 0; sent < wanted; seed++) {
    const batch = fc.sample(conversations, { numRuns: atOnce, seed });
    await Promise.all(batch.map((frames, i) => converse(relay.url, stages[i % stages.length]!, frames)));
    sent += batch.reduce((sum, frames) => sum + frames.length, 0);
    talks += batch.length;
    expect(relay.isAlive(), `seed ${seed}`).toBe(true);
    const before = pongs();
    const asked = performance.now();
    witness.say({ type: 'ping', sent: seed });
    await until(`the answer to another, after seed ${seed}`, () => pongs() > before || witness.closedAt !== null);
    expect(witness.closedAt, `seed ${seed}: ${JSON.stringify(witness.heard.at(-1))}`).toBeNull();
    waits.push(performance.now() - asked);
    witness.heard.length = 0;
  }
  const census = async () => (await (await fetch(`${relay.url}/healthz`)).json()) as { readonly sockets: number };
  await expect.poll(async () => (await census()).sockets, { timeout: 30_000 }).toBe(1);
  reportFigures('any-packet', {
    frames: sent,
    connections: talks,
    'processes ended': relay.isAlive() ? 0 : 1,
    'longest wait of another for an answer [ms]': Math.max(...waits),
  });
});
