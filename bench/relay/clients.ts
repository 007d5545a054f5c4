// The load, in a process of its own: lean clients that speak WebSocket without socket.io's client, so that the relay is
// what is measured.

import { actorFrame, defaultAvatar, defaultCalibration, skeletonFromCalibration } from 'threepoint/core';
import { ballKind } from 'threepoint-games/ball';
import { RoomTokens } from 'threepoint-relay';
import { WebSocket } from 'ws';
import { protocolVersion } from '../../src/rooms/protocol/messages';
import { packetMs } from '../../src/rooms/protocol/packet-time';
import { encodePose } from '../../src/rooms/protocol/pose-codec';
import { decodeFrame } from '../../src/rooms/protocol/pose-frame';
import { relaxedHand } from '../../src/threepoint/core/body/hand-shape';
import { createIk } from '../../src/threepoint/core/estimation/estimators';
import { countingKind } from '../../tests/rooms/room/counting-game';
import type { ClientAnswer, Farewell, Load, Meeting, PoseLatencies } from './conversation';

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

/** The first bit of the time in a pose packet, and its number of bits (`writePacket`). */
const timeAt = 13;
const timeBits = 14;

/** Writes the packet's time into its bytes. */
function setTime(bytes: Uint8Array, timeMs: number): void {
  for (let bit = 0; bit < timeBits; bit++) {
    const at = timeAt + bit;
    const mask = 0x80 >> (at & 7);
    if ((timeMs >> (timeBits - 1 - bit)) & 1) bytes[at >> 3]! |= mask;
    else bytes[at >> 3]! &= ~mask;
  }
}

function timeOf(bytes: Uint8Array): number {
  let time = 0;
  for (let at = timeAt; at < timeAt + timeBits; at++) time = (time << 1) | ((bytes[at >> 3]! >> (7 - (at & 7))) & 1);
  return time;
}

/** Announces the pose packet that follows, where the relay is the plain one. */
const head = '451-["pose",{"_placeholder":true,"num":0}]';

/** The delays of each part of a measurement are judged by themselves [s]. */
const partSeconds = 0.5;
/** A pose that arrives later than this after the measurement has not arrived [s]. */
const patienceSeconds = 0.25;

/** What the clients count of the poses that leave in some seconds. Times: this process's clock [ms]. */
class Measurement {
  readonly #start: number;
  readonly #end: number;
  readonly #parts: readonly number[][];
  readonly #cpu = process.cpuUsage();
  #sent = 0;
  #delivered = 0;
  #bytesUp = 0;
  #bytesDown = 0;

  constructor(start: number, seconds: number) {
    this.#start = start;
    this.#end = start + seconds * 1000;
    this.#parts = Array.from({ length: Math.ceil(seconds / partSeconds) }, () => []);
  }

  /** A pose leaves. */
  left(now: number, bytes: number): void {
    if (!this.#counts(now)) return;
    this.#sent += 1;
    this.#bytesUp += bytes;
  }

  /** A pose has arrived that left at `left`, in so many bytes of what came. */
  arrived(left: number, bytes: number): void {
    if (!this.#counts(left)) return;
    this.#delivered += 1;
    this.#bytesDown += bytes;
    this.#parts[Math.floor((left - this.#start) / (1000 * partSeconds))]?.push(performance.now() - left);
  }

  result(): PoseLatencies {
    const used = process.cpuUsage(this.#cpu);
    const seconds = (this.#end - this.#start) / 1000;
    for (const part of this.#parts) part.sort((x, y) => x - y);
    return {
      p50Ms: this.#typical(0.5),
      p99Ms: this.#typical(0.99),
      sent: this.#sent,
      delivered: this.#delivered,
      bytesUp: this.#bytesUp,
      bytesDown: this.#bytesDown,
      seconds,
      clientLoad: (used.user + used.system) / ((seconds + patienceSeconds) * 1e6),
    };
  }

  #counts(time: number): boolean {
    return time >= this.#start && time < this.#end;
  }

  /** The median over the parts: one in which the machine did something else says nothing about the relay. */
  #typical(share: number): number {
    const values = this.#parts.map((part) => part[Math.floor((part.length - 1) * share)] ?? Number.POSITIVE_INFINITY);
    return values.sort((x, y) => x - y)[Math.floor((values.length - 1) / 2)] ?? Number.NaN;
  }
}

/** What is counted now; null: nothing is. One for all clients of the process. */
let measurement: Measurement | null = null;

/** The place of a client: its room, with the clients who came before it, and what lets it in. */
interface Place {
  readonly room: Client[];
  readonly roomName: string;
  readonly seat: number;
  readonly token: string;
}

class Client {
  /** When its next packet is to leave [ms]. */
  due = 0;
  readonly #plain: boolean;
  readonly #plays: boolean;
  readonly #room: readonly Client[];
  readonly #token: string;
  readonly #socket: WebSocket;
  readonly #bytes: Uint8Array;
  /** The time at which each packet was sent, by its packet time [ms]. */
  readonly #sent = new Float64Array(2 ** timeBits);
  /** Resolves once the relay has let it in. */
  readonly joined: Promise<void>;
  #join: () => void = () => undefined;
  #seat: number;
  /** The offset of the relay's clock to the local clock [ms]. */
  #ahead = 0;
  /**
   * For the plain relay: the sender of the next binary message, and the length of the text that announced it [bytes].
   */
  #from = 0;
  #announced = 0;

  constructor({ relay, port, plays = false }: Meeting, template: Uint8Array, { room, roomName, seat, token }: Place) {
    this.#plain = relay === 'plain';
    this.#plays = plays;
    this.#room = room;
    this.#token = token;
    this.#seat = seat;
    this.#bytes = template.slice();
    const address = `ws://127.0.0.1:${port}/relay/?EIO=4&transport=websocket&room=${roomName}&seat=${seat}`;
    const socket = new WebSocket(address, { perMessageDeflate: false });
    this.#socket = socket;
    this.joined = new Promise((resolve, reject) => {
      this.#join = resolve;
      socket.on('error', reject);
      socket.on('close', () => reject(new Error('bench/relay: a connection was closed')));
    });
    socket.on('message', (received: Buffer, isBinary) => this.#receive(received, isBinary));
  }

  send(): void {
    const now = performance.now();
    const timeMs = packetMs(now + this.#ahead);
    setTime(this.#bytes, timeMs);
    this.#sent[timeMs] = now;
    if (this.#plain) this.#socket.send(head);
    this.#socket.send(this.#bytes);
    measurement?.left(now, this.#bytes.length + (this.#plain ? head.length : 0));
  }

  leave(): void {
    this.#sendMessage({ type: 'leave' });
  }

  #sendMessage(message: object): void {
    this.#sendText(`42${JSON.stringify(['/', ['message', message]])}`);
  }

  #sendText(text: string): void {
    this.#socket.send(text);
  }

  #receive(received: Buffer, isBinary: boolean): void {
    if (!isBinary) {
      this.#receiveText(received.toString());
      return;
    }
    if (this.#plain) {
      this.#receivePose(this.#from, received, this.#announced + received.length);
      return;
    }
    const poses = decodeFrame(received) ?? [];
    for (const { seat, bytes } of poses) this.#receivePose(seat, bytes, received.length / poses.length);
  }

  /** `cost`: this pose's share of what came [bytes]. */
  #receivePose(seat: number, bytes: Uint8Array, cost: number): void {
    if (seat === this.#seat) return;
    for (const client of this.#room) {
      if (client.#seat !== seat) continue;
      const left = client.#sent[timeOf(bytes)];
      if (left) measurement?.arrived(left, cost);
      return;
    }
  }

  /** Answers the messages of socket.io's protocol that the relays send. */
  #receiveText(text: string): void {
    const plain = this.#plain;
    if (text === '2') this.#sendText('3');
    else if (text[0] === '0') this.#sendText(plain ? '40' : `40${JSON.stringify(['/', { token: this.#token }])}`);
    else if (plain) this.#receivePlain(text);
    else if (text.startsWith('40')) this.#requestToJoin();
    else if (text.includes('"welcome"')) this.#welcomed(JSON.parse(text.slice(2))[1][1]);
  }

  #receivePlain(text: string): void {
    const pose = /^451-\["pose",(\d+),/.exec(text);
    if (pose) {
      this.#from = Number(pose[1]);
      this.#announced = text.length;
    } else if (text.startsWith('40')) this.#join();
  }

  #requestToJoin(): void {
    const person = {
      name: `P${this.#seat}`,
      calibration: defaultCalibration,
      spectate: false,
      bot: false,
      seat: null,
      avatar: defaultAvatar,
      voice: null,
    };
    this.#sendMessage({ type: 'join', version: protocolVersion, ...person });
  }

  #welcomed({ seat, time }: { readonly seat: number; readonly time: number }): void {
    this.#seat = seat;
    this.#ahead = time * 1000 - performance.now();
    if (this.#plays) this.#sendMessage({ type: 'ready', ready: true });
    this.#join();
  }
}

/** All who have come, room by room, and the load that they are. */
class Crowd {
  readonly #meeting: Meeting;
  readonly #template = packet();
  readonly #rooms: Client[][] = [];

  constructor(meeting: Meeting) {
    this.#meeting = meeting;
  }

  /** Plays in so many rooms; more people come where there are not as many yet. */
  async play({ rooms, warmUpSeconds, seconds }: Load): Promise<PoseLatencies> {
    while (this.#rooms.length < rooms) await this.#open();
    const clients = this.#rooms.slice(0, rooms).flat();
    const start = performance.now() + warmUpSeconds * 1000;
    const end = start + (seconds + patienceSeconds) * 1000;
    await this.#sendUntil(start, clients);
    measurement = new Measurement(performance.now(), seconds);
    process.send?.('measuring' satisfies ClientAnswer);
    await this.#sendUntil(end, clients);
    const latencies = measurement.result();
    measurement = null;
    return latencies;
  }

  leave(): void {
    for (const client of this.#rooms.flat()) client.leave();
  }

  /** Another room, with people who come one after the other: its seats are given in that order. */
  async #open(): Promise<void> {
    const { relay, secret, room: people, plays = false } = this.#meeting;
    const tokens = new RoomTokens(secret, () => Date.now() / 1000);
    const roomName = `room-${this.#rooms.length}`;
    const room: Client[] = [];
    for (let seat = 0; seat < people; seat++) {
      const token =
        relay === 'ours' ? await tokens.issue(roomName, kindFor(people), plays ? { seconds: 3600 } : {}) : '';
      const client = new Client(this.#meeting, this.#template, { room, roomName, seat, token });
      await client.joined;
      room.push(client);
    }
    this.#rooms.push(room);
  }

  /** Lets each client send at the meeting's rate until then [ms]. No two clients' frames keep step. */
  #sendUntil(end: number, clients: readonly Client[]): Promise<void> {
    const period = 1000 / this.#meeting.hz;
    const begin = performance.now();
    clients.forEach((client, i) => {
      if (client.due < begin - period) client.due = begin + period * ((i * 0.618034) % 1);
    });
    return new Promise((resolve) => {
      const timer = setInterval(() => {
        const now = performance.now();
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
}

/** Rooms of three play the ball game; others play a small test game, because no shipped game has as many seats. */
const kindFor = (people: number): string => (people === 3 ? ballKind : countingKind);

let crowd: Crowd | null = null;

async function answer(message: Meeting | Load | Farewell): Promise<void> {
  if (message === 'leave') crowd?.leave();
  else if ('port' in message) crowd = new Crowd(message);
  else if (crowd) process.send?.((await crowd.play(message)) satisfies ClientAnswer);
}

process.on('message', (message: Meeting | Load | Farewell) => {
  answer(message).catch((error: Error) => {
    console.error(error.message);
    process.exit(1);
  });
});
