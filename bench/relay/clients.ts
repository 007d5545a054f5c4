// The load, in a process of its own: lean clients that speak WebSocket without socket.io's client, so that the relay is what is measured.
import { WebSocket } from 'ws';
import { defaultCalibration } from '../../src/core/body/calibration';
import { skeletonFromCalibration } from '../../src/core/body/skeleton';
import { createIk } from '../../src/core/estimation/estimators';
import { protocolVersion } from '../../src/core/protocol/messages';
import { encodePose } from '../../src/core/protocol/pose-codec';
import { decodeFrame } from '../../src/core/protocol/pose-frame';
import { actorFrame } from '../../src/core/tracking/actor-motion';
import type { Heard, Load } from './conversation';

/** A pose packet as players send it most: two controllers and a body. */
function packet(): Uint8Array {
  const skeleton = skeletonFromCalibration(defaultCalibration);
  const frame = actorFrame(10, defaultCalibration);
  const { pose } = createIk(defaultCalibration).update(frame);
  const bytes = encodePose(
    { timeMs: 0, jump: false, pose, grips: { left: 0, right: 0 }, curls: { left: null, right: null } },
    skeleton,
  );
  if (!bytes) throw new Error('bench/relay: the actor has no finite pose');
  return bytes;
}

const timeAt = 15;

/** Writes the packet's time (16 bits from bit 15 on) into its bytes. */
function setTime(bytes: Uint8Array, timeMs: number): void {
  for (let bit = 0; bit < 16; bit++) {
    const at = timeAt + bit;
    const mask = 0x80 >> (at & 7);
    if ((timeMs >> (15 - bit)) & 1) bytes[at >> 3]! |= mask;
    else bytes[at >> 3]! &= ~mask;
  }
}

function timeOf(bytes: Uint8Array): number {
  let time = 0;
  for (let at = timeAt; at < timeAt + 16; at++) time = (time << 1) | ((bytes[at >> 3]! >> (7 - (at & 7))) & 1);
  return time;
}

interface Client {
  readonly socket: WebSocket;
  readonly bytes: Uint8Array;
  /** When each packet left, by the time it tells [ms]. */
  readonly sent: Float64Array;
  /** What the relay's clock is ahead of ours [ms]. */
  ahead: number;
  seat: number;
  due: number;
}

async function play(load: Load): Promise<Heard> {
  const template = packet();
  /** Of each second of the measurement. */
  let windows: number[][] = [];
  let measuring = false;
  let start = 0;
  let [sent, delivered, bytesUp, bytesDown] = [0, 0, 0, 0];
  const rooms: Client[][] = [];

  const arrived = (room: readonly Client[], own: Client, seat: number, bytes: Uint8Array): void => {
    if (seat === own.seat || !measuring) return;
    const left = room.find((client) => client.seat === seat)?.sent[timeOf(bytes)];
    if (!left) return;
    delivered += 1;
    const now = performance.now();
    windows[Math.floor((now - start) / 1000)]?.push(now - left);
  };

  function connect(room: Client[], roomName: string, seat: number, token: string): Promise<Client> {
    return new Promise((resolve, reject) => {
      const address = `ws://127.0.0.1:${load.port}/relay/?EIO=4&transport=websocket&room=${roomName}&seat=${seat}`;
      const socket = new WebSocket(address, { perMessageDeflate: false });
      const client: Client = {
        socket,
        bytes: template.slice(),
        sent: new Float64Array(65536),
        ahead: 0,
        seat,
        due: 0,
      };
      let from = 0;
      const say = (text: string): void => socket.send(text);
      const hearText = (text: string): void => {
        if (text === '2') say('3');
        else if (text[0] === '0') say(load.relay === 'ours' ? `40${JSON.stringify(['/', { token }])}` : '40');
        else if (load.relay === 'plain') {
          const pose = /^451-\["pose",(\d+),/.exec(text);
          if (pose) from = Number(pose[1]);
          else if (text.startsWith('40')) resolve(client);
        } else if (text.startsWith('40')) {
          const join = { name: `P${seat}`, calibration: defaultCalibration, spectate: false, bot: false, seat: null };
          const message = { type: 'join', version: protocolVersion, ...join };
          say(`42${JSON.stringify(['/', ['message', message]])}`);
        } else if (text.includes('"welcome"')) {
          const welcome = JSON.parse(text.slice(2))[1][1];
          client.seat = welcome.seat;
          client.ahead = welcome.time * 1000 - performance.now();
          resolve(client);
        }
      };
      socket.on('message', (received: Buffer, isBinary) => {
        if (measuring) bytesDown += received.length;
        if (!isBinary) hearText(received.toString());
        else if (load.relay === 'plain') arrived(room, client, from, received);
        else for (const pose of decodeFrame(received) ?? []) arrived(room, client, pose.seat, pose.bytes);
      });
      socket.on('error', reject);
      socket.on('close', () => reject(new Error('bench/relay: a connection was closed')));
    });
  }

  const head = '451-["pose",{"_placeholder":true,"num":0}]';
  function send(client: Client): void {
    const timeMs = Math.round(performance.now() + client.ahead) & 0xffff;
    setTime(client.bytes, timeMs);
    client.sent[timeMs] = performance.now();
    if (load.relay === 'plain') client.socket.send(head);
    client.socket.send(client.bytes);
    if (!measuring) return;
    sent += 1;
    bytesUp += client.bytes.length + (load.relay === 'plain' ? head.length : 0);
  }

  for (let r = 0; r < load.rooms; r++) {
    const room: Client[] = [];
    rooms.push(room);
    for (let seat = 0; seat < load.room; seat++) {
      const token = load.tokens[r * load.room + seat] ?? '';
      room.push(await connect(room, `room-${r}`, seat, token));
    }
  }
  const clients = rooms.flat();
  const period = 1000 / load.hz;
  const begin = performance.now();
  // No two clients' frames keep step.
  clients.forEach((client, i) => {
    client.due = begin + period * ((i * 0.618034) % 1);
  });
  start = begin + load.warmUpSeconds * 1000;
  windows = Array.from({ length: load.seconds }, () => []);
  const end = start + load.seconds * 1000;
  let cpu = process.cpuUsage();
  await new Promise<void>((resolve) => {
    const timer = setInterval(() => {
      const now = performance.now();
      if (!measuring && now >= start) {
        measuring = true;
        cpu = process.cpuUsage();
        process.send?.('measuring');
      }
      for (const client of clients) {
        if (client.due > now) continue;
        send(client);
        client.due = Math.max(client.due + period, now - period);
      }
      if (now < end) return;
      clearInterval(timer);
      resolve();
    }, 1);
  });
  measuring = false;
  const used = process.cpuUsage(cpu);
  for (const { socket } of clients) {
    socket.removeAllListeners();
    socket.on('error', () => socket.terminate());
    socket.terminate();
  }
  for (const window of windows) window.sort((x, y) => x - y);
  /** The median over the seconds: one in which the machine did something else says nothing about the relay. */
  const typical = (share: number): number => {
    const values = windows.map((window) => window[Math.floor((window.length - 1) * share)] ?? Number.POSITIVE_INFINITY);
    return values.sort((x, y) => x - y)[Math.floor((values.length - 1) / 2)] ?? Number.NaN;
  };
  return {
    p50Ms: typical(0.5),
    p99Ms: typical(0.99),
    sent,
    delivered,
    bytesUp,
    bytesDown,
    seconds: load.seconds,
    clientLoad: (used.user + used.system) / (load.seconds * 1e6),
  };
}

process.on('message', (load: Load) => {
  play(load).then(
    (heard) => process.send?.(heard),
    (error: Error) => {
      console.error(error.message);
      process.exit(1);
    },
  );
});
