// The load, in a process of its own: lean clients that speak WebSocket without socket.io's client, so that the relay is what is measured.
import { WebSocket } from 'ws';
import { defaultCalibration } from '../../src/core/body/calibration';
import { relaxedHand } from '../../src/core/body/hand-shape';
import { skeletonFromCalibration } from '../../src/core/body/skeleton';
import { createIk } from '../../src/core/estimation/estimators';
import { protocolVersion } from '../../src/core/protocol/messages';
import { encodePose } from '../../src/core/protocol/pose-codec';
import { decodeFrame } from '../../src/core/protocol/pose-frame';
import { plainAvatar } from '../../src/core/protocol/worn-avatar';
import { actorFrame } from '../../src/core/tracking/actor-motion';
import type { Heard, Load } from './conversation';

/** A pose packet as players send it most: two controllers and a body. */
function packet(): Uint8Array {
  const skeleton = skeletonFromCalibration(defaultCalibration);
  const frame = actorFrame(10, defaultCalibration);
  const { pose } = createIk(defaultCalibration).update(frame);
  const bytes = encodePose(
    { timeMs: 0, jump: false, pose, fingers: { left: relaxedHand, right: relaxedHand } },
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

/** Announces the pose packet that follows, where the relay is the plain one. */
const head = '451-["pose",{"_placeholder":true,"num":0}]';

/** What the clients of all rooms count between the start and the end of the measurement. */
class Measurement {
  /** Announced by the first frame after the start. */
  running = false;
  start = 0;
  sent = 0;
  delivered = 0;
  bytesUp = 0;
  bytesDown = 0;
  /** The delays of each second [ms]. */
  readonly #windows: readonly number[][];
  #cpu = process.cpuUsage();

  constructor(seconds: number) {
    this.#windows = Array.from({ length: seconds }, () => []);
  }

  begin(): void {
    this.running = true;
    this.#cpu = process.cpuUsage();
    process.send?.('measuring');
  }

  /** A pose has arrived that left at `left` [ms]. */
  arrived(left: number): void {
    this.delivered += 1;
    const now = performance.now();
    this.#windows[Math.floor((now - this.start) / 1000)]?.push(now - left);
  }

  end(): Heard {
    this.running = false;
    const used = process.cpuUsage(this.#cpu);
    const seconds = this.#windows.length;
    for (const window of this.#windows) window.sort((x, y) => x - y);
    const { sent, delivered, bytesUp, bytesDown } = this;
    return {
      p50Ms: this.#typical(0.5),
      p99Ms: this.#typical(0.99),
      sent,
      delivered,
      bytesUp,
      bytesDown,
      seconds,
      clientLoad: (used.user + used.system) / (seconds * 1e6),
    };
  }

  /** The median over the seconds: one in which the machine did something else says nothing about the relay. */
  #typical(share: number): number {
    const values = this.#windows.map(
      (window) => window[Math.floor((window.length - 1) * share)] ?? Number.POSITIVE_INFINITY,
    );
    return values.sort((x, y) => x - y)[Math.floor((values.length - 1) / 2)] ?? Number.NaN;
  }
}

/** The place of a client in the load: its room, with the clients who came before it, and what lets it in. */
interface Place {
  readonly room: Client[];
  readonly roomName: string;
  readonly seat: number;
  readonly token: string;
}

class Client {
  /** When its next packet is to leave [ms]. */
  due = 0;
  readonly #load: Load;
  readonly #measurement: Measurement;
  readonly #room: readonly Client[];
  readonly #token: string;
  readonly #socket: WebSocket;
  readonly #bytes: Uint8Array;
  /** When each packet left, by the time it tells [ms]. */
  readonly #sent = new Float64Array(65536);
  readonly #joined: Promise<void>;
  #join: () => void = () => undefined;
  #seat: number;
  /** What the relay's clock is ahead of ours [ms]. */
  #ahead = 0;
  /** Of the plain relay: whose pose comes with the next binary message. */
  #from = 0;

  constructor(load: Load, measurement: Measurement, template: Uint8Array, { room, roomName, seat, token }: Place) {
    this.#load = load;
    this.#measurement = measurement;
    this.#room = room;
    this.#token = token;
    this.#seat = seat;
    this.#bytes = template.slice();
    const address = `ws://127.0.0.1:${load.port}/relay/?EIO=4&transport=websocket&room=${roomName}&seat=${seat}`;
    const socket = new WebSocket(address, { perMessageDeflate: false });
    this.#socket = socket;
    this.#joined = new Promise((resolve, reject) => {
      this.#join = resolve;
      socket.on('error', reject);
      socket.on('close', () => reject(new Error('bench/relay: a connection was closed')));
    });
    socket.on('message', (received: Buffer, isBinary) => this.#hear(received, isBinary));
  }

  /** Resolves once the relay has let it in. */
  joined(): Promise<void> {
    return this.#joined;
  }

  send(): void {
    const plain = this.#load.relay === 'plain';
    const timeMs = Math.round(performance.now() + this.#ahead) & 0xffff;
    setTime(this.#bytes, timeMs);
    this.#sent[timeMs] = performance.now();
    if (plain) this.#socket.send(head);
    this.#socket.send(this.#bytes);
    if (!this.#measurement.running) return;
    this.#measurement.sent += 1;
    this.#measurement.bytesUp += this.#bytes.length + (plain ? head.length : 0);
  }

  close(): void {
    const socket = this.#socket;
    socket.removeAllListeners();
    socket.on('error', () => socket.terminate());
    socket.terminate();
  }

  #say(text: string): void {
    this.#socket.send(text);
  }

  #hear(received: Buffer, isBinary: boolean): void {
    if (this.#measurement.running) this.#measurement.bytesDown += received.length;
    if (!isBinary) this.#hearText(received.toString());
    else if (this.#load.relay === 'plain') this.#hearPose(this.#from, received);
    else for (const { seat, bytes } of decodeFrame(received) ?? []) this.#hearPose(seat, bytes);
  }

  #hearPose(seat: number, bytes: Uint8Array): void {
    if (seat === this.#seat || !this.#measurement.running) return;
    for (const client of this.#room) {
      if (client.#seat !== seat) continue;
      const left = client.#sent[timeOf(bytes)];
      if (left) this.#measurement.arrived(left);
      return;
    }
  }

  /** The words of socket.io's protocol, as far as the relays speak it with a client. */
  #hearText(text: string): void {
    const plain = this.#load.relay === 'plain';
    if (text === '2') this.#say('3');
    else if (text[0] === '0') this.#say(plain ? '40' : `40${JSON.stringify(['/', { token: this.#token }])}`);
    else if (plain) this.#hearPlain(text);
    else if (text.startsWith('40')) this.#askIn();
    else if (text.includes('"welcome"')) this.#welcomed(JSON.parse(text.slice(2))[1][1]);
  }

  #hearPlain(text: string): void {
    const pose = /^451-\["pose",(\d+),/.exec(text);
    if (pose) this.#from = Number(pose[1]);
    else if (text.startsWith('40')) this.#join();
  }

  #askIn(): void {
    const person = {
      name: `P${this.#seat}`,
      calibration: defaultCalibration,
      spectate: false,
      bot: false,
      seat: null,
      avatar: plainAvatar,
    };
    const message = { type: 'join', version: protocolVersion, ...person };
    this.#say(`42${JSON.stringify(['/', ['message', message]])}`);
  }

  #welcomed({ seat, time }: { readonly seat: number; readonly time: number }): void {
    this.#seat = seat;
    this.#ahead = time * 1000 - performance.now();
    this.#join();
  }
}

/** One after the other: a room's seats are given in the order in which its clients come. */
async function connectAll(load: Load, measurement: Measurement): Promise<readonly Client[]> {
  const template = packet();
  const clients: Client[] = [];
  for (let r = 0; r < load.rooms; r++) {
    const room: Client[] = [];
    for (let seat = 0; seat < load.room; seat++) {
      const token = load.tokens[clients.length] ?? '';
      const client = new Client(load, measurement, template, { room, roomName: `room-${r}`, seat, token });
      await client.joined();
      room.push(client);
      clients.push(client);
    }
  }
  return clients;
}

/** Lets each client send at the load's rate, through the warm-up and the measurement. */
function sendAll(clients: readonly Client[], measurement: Measurement, load: Load): Promise<void> {
  const period = 1000 / load.hz;
  const begin = performance.now();
  // No two clients' frames keep step.
  clients.forEach((client, i) => {
    client.due = begin + period * ((i * 0.618034) % 1);
  });
  measurement.start = begin + load.warmUpSeconds * 1000;
  const end = measurement.start + load.seconds * 1000;
  return new Promise((resolve) => {
    const timer = setInterval(() => {
      const now = performance.now();
      if (!measurement.running && now >= measurement.start) measurement.begin();
      for (const client of clients) {
        if (client.due > now) continue;
        client.send();
        client.due = Math.max(client.due + period, now - period);
      }
      if (now < end) return;
      clearInterval(timer);
      resolve();
    }, 1);
  });
}

async function play(load: Load): Promise<Heard> {
  const measurement = new Measurement(load.seconds);
  const clients = await connectAll(load, measurement);
  await sendAll(clients, measurement, load);
  const heard = measurement.end();
  for (const client of clients) client.close();
  return heard;
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
