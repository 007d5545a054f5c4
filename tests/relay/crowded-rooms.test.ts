import { fork } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { expect, onTestFinished, test } from 'vitest';
import type { ClientAnswer, Farewell, Load, Meeting, PoseLatencies } from '../../bench/relay/conversation';
import { isNightly } from '../nightly';
import { reportFigures } from '../reliability/report-figures';
import { kill, messageFrom } from '../server/child-process';
import { forkServer } from '../server/server-child';
import { testSecret } from '../server/started-server';

const crowd = { rooms: isNightly ? 200 : 20, seconds: isNightly ? 600 : 5 };
/** After it, to see whether what the process takes grows from crowd to crowd. */
const later = { rooms: crowd.rooms, seconds: isNightly ? 30 : 5, times: isNightly ? 2 : 1 };
/** Before it, so that the code is compiled and every buffer has been used once. */
const warmUp = { rooms: 20, seconds: 3 };
const clientsScript = fileURLToPath(new URL('../../bench/relay/clients.ts', import.meta.url));

interface Census {
  readonly rooms: number;
  readonly players: number;
  readonly sockets: number;
}

/** Three players in each of so many rooms, in a process of their own, who play at thirty poses a second. */
async function play(port: number, { rooms, seconds }: typeof crowd) {
  const clients = fork(clientsScript, [], { execArgv: ['--import', 'tsx'] });
  onTestFinished(() => kill(clients));
  clients.send({ relay: 'ours', port, secret: testSecret, room: 3, hz: 30, plays: true } satisfies Meeting);
  clients.send({ rooms, warmUpSeconds: 1, seconds } satisfies Load);
  expect(await messageFrom<ClientAnswer>(clients)).toBe('measuring');
  return {
    heard: await messageFrom<PoseLatencies>(clients),
    /** Gives up the seats; those of clients whose process is killed are held for half a minute. */
    leave: () => clients.send('leave' satisfies Farewell),
    kill: () => kill(clients),
  };
}

test('rooms of three play on time and leave nothing when their players do, repeatedly', {
  tags: ['full'],
  timeout: 1_800_000,
}, async () => {
  const relay = await forkServer({ THREEPOINT_CONNECTIONS_PER_ADDRESS: '5000' });
  const idle = await forkServer();
  let census: Census = { rooms: 0, players: 0, sockets: 0 };
  const ask = async () => {
    census = (await (await fetch(`${relay.url}/healthz`)).json()) as Census;
    return census;
  };
  const gone = () => expect.poll(ask, { timeout: 120_000, interval: 500 }).toMatchObject({ rooms: 0, sockets: 0 });

  const first = await play(relay.port, warmUp);
  first.leave();
  await gone();
  const before = await relay.inspect({ collect: true });
  // The delay of the event loop is measured from here.
  await Promise.all([relay.inspect(), idle.inspect()]);

  const { heard, kill: disconnect } = await play(relay.port, crowd);
  const [during, machine] = await Promise.all([relay.inspect({ collect: true }), idle.inspect()]);
  expect(await ask()).toMatchObject({ rooms: crowd.rooms, players: 3 * crowd.rooms });
  await disconnect();
  await gone();
  const after = [await relay.inspect({ collect: true })];
  for (let i = 0; i < later.times; i++) {
    const again = await play(relay.port, later);
    again.leave();
    await gone();
    after.push(await relay.inspect({ collect: true }));
  }
  const mb = (bytes: number) => bytes / 2 ** 20;
  reportFigures('crowd', {
    rooms: crowd.rooms,
    seconds: crowd.seconds,
    'poses delivered [%]': (100 * heard.delivered) / (2 * heard.sent),
    'p99 of a pose on its way [ms]': heard.p99Ms,
    'event loop p99 [ms]': during.loop.p99Ms,
    "an idle process's p99 [ms]": machine.loop.p99Ms,
    'held before, during, after, after a second and a third crowd [MB]': [before, during, ...after]
      .map(({ heldBytes }) => mb(heldBytes).toFixed(1))
      .join(', '),
    'memory of the process, likewise [MB]': [before, during, ...after]
      .map(({ rssBytes }) => mb(rssBytes).toFixed(0))
      .join(', '),
  });
  for (const { heldBytes, rssBytes } of after) {
    expect(heldBytes).toBeLessThan(1.05 * before.heldBytes);
    expect(rssBytes).toBeLessThan(1.05 * (after[0]?.rssBytes ?? 0));
  }
  // 20 ms; more where an idle process waits too, as six hundred clients share its cores.
  expect(during.loop.p99Ms).toBeLessThan(20 + 20 * Math.max(0, machine.loop.p99Ms - 10));
  expect(heard.delivered).toBeGreaterThan(1.8 * heard.sent);
});
