import { type ChildProcess, fork } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { messageFrom } from '../../tests/server/child-process';
import type { Cell, ClientAnswer, Load, Meeting, PoseLatencies, RelayGreeting, RelayUsage } from './conversation';

/** How one load went. */
export interface Trial {
  readonly clients: number;
  readonly p50Ms: number;
  readonly p99Ms: number;
  /** CPU time of the relay for each pose that reached a client [µs]. */
  readonly cpuPerPoseUs: number;
  /** Share of a core. */
  readonly cpu: number;
  /** Payload of the messages with poses, for each pose of an avatar that leaves, and that arrives [bytes]. */
  readonly bytesUp: number;
  readonly bytesDown: number;
  /** Memory of the relay's process [MB]. */
  readonly rssMb: number;
  /** Share of the poses sent that reached the others. */
  readonly delivered: number;
  /** Share of a core that the clients took: near 1, they are what was measured. */
  readonly clientLoad: number;
}

/** The p99 that a count of clients must stay below [ms], and the share of the poses that must reach the others. */
export const bound = 20;
export const minDelivered = 0.999;
const secret = 'bench-kN3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gAzE4uV7iO';
const warmUpSeconds = 0.7;
/** Clients of the light load. */
const few = 24;

/** How a search is done. */
export interface SearchOptions {
  /** The duration of each load. */
  readonly seconds: number;
  /** The search ends where the next count would be nearer than this share of it. */
  readonly nearness: number;
}

const script = (name: string): string => fileURLToPath(new URL(name, import.meta.url));
const start = (name: string): ChildProcess =>
  fork(script(name), {
    execArgv: ['--import', 'tsx'],
    env: {
      ...process.env,
      THREEPOINT_SECRET: secret,
      THREEPOINT_LOG_LEVEL: 'warn',
      THREEPOINT_POSES_PER_SECOND: '200',
      THREEPOINT_MOST_ROOMS: '100000',
      // All of the load comes from one address.
      THREEPOINT_CONNECTIONS_PER_ADDRESS: '100000',
    },
  });

/** A relay and its clients, each a process of its own, under one load after another. */
class Drive {
  readonly #cell: Cell;
  readonly #seconds: number;
  readonly #relay: ChildProcess;
  readonly #clients = start('./clients.ts');

  constructor(cell: Cell, seconds: number) {
    this.#cell = cell;
    this.#seconds = seconds;
    this.#relay = start(cell.relay === 'ours' ? './our-relay.ts' : './plain-relay.ts');
  }

  async begin(): Promise<void> {
    const { port } = await messageFrom<RelayGreeting>(this.#relay);
    this.#clients.send({ ...this.#cell, port, secret } satisfies Meeting);
  }

  end(): void {
    this.#relay.kill();
    this.#clients.kill();
  }

  async trial(rooms: number): Promise<Trial> {
    const { room } = this.#cell;
    this.#clients.send({ rooms, warmUpSeconds, seconds: this.#seconds } satisfies Load);
    await messageFrom<ClientAnswer>(this.#clients);
    const before = await this.#usage();
    const result = await messageFrom<PoseLatencies>(this.#clients);
    const after = await this.#usage();
    const used = after.cpuMicroseconds - before.cpuMicroseconds;
    return {
      clients: room * rooms,
      p50Ms: result.p50Ms,
      p99Ms: result.p99Ms,
      cpuPerPoseUs: used / result.delivered,
      cpu: used / (result.seconds * 1e6),
      bytesUp: result.bytesUp / result.sent,
      bytesDown: result.bytesDown / result.delivered,
      rssMb: after.rssBytes / 2 ** 20,
      delivered: result.delivered / (result.sent * (room - 1)),
      clientLoad: result.clientLoad,
    };
  }

  #usage(): Promise<RelayUsage> {
    this.#relay.send('usage');
    return messageFrom(this.#relay);
  }
}

const holds = ({ p99Ms, delivered }: Trial): boolean => p99Ms < bound && delivered >= minDelivered;

function printTrial({ relay, room, hz }: Cell, { clients, p99Ms, cpu, clientLoad, delivered }: Trial): void {
  console.log(
    `  ${relay.padEnd(5)} rooms of ${String(room).padStart(2)} at ${hz} Hz, ${String(clients).padStart(4)} clients: ` +
      `p99 ${p99Ms.toFixed(1)} ms, relay ${(100 * cpu).toFixed(0)} %, clients ${(100 * clientLoad).toFixed(0)} % of a core, ` +
      `${(100 * delivered).toFixed(2)} % delivered`,
  );
}

/** Twice at most: a busy moment of the machine is no answer. */
async function attempt(drive: Drive, cell: Cell, rooms: number): Promise<Trial> {
  const first = await drive.trial(rooms);
  printTrial(cell, first);
  if (holds(first)) return first;
  const second = await drive.trial(rooms);
  printTrial(cell, second);
  return holds(second) ? second : first;
}

/** The light load, and the most clients that hold the bounds. */
export interface Found {
  readonly light: Trial;
  readonly most: Trial;
}

/**
 * How many times as many clients may bring the busier process to three quarters of a core; a third more at least, three
 * times at most.
 */
const growth = ({ cpu, clientLoad }: Trial): number => Math.min(3, Math.max(1.33, 0.75 / Math.max(cpu, clientLoad)));

/** Up until the bound breaks, then halfway between what held and what broke. */
async function climb(drive: Drive, cell: Cell, light: Trial, nearness: number): Promise<Trial> {
  let most = light;
  let broken = Number.POSITIVE_INFINITY;
  for (;;) {
    const held = most.clients / cell.room;
    const rooms =
      broken === Number.POSITIVE_INFINITY ? Math.ceil(held * growth(most)) : Math.floor((held + broken) / 2);
    if (broken - held <= Math.max(1, nearness * held)) return most;
    const trial = await attempt(drive, cell, rooms);
    if (holds(trial)) most = trial;
    else broken = rooms;
  }
}

export async function search(cell: Cell, { seconds, nearness }: SearchOptions): Promise<Found> {
  const drive = new Drive(cell, seconds);
  try {
    await drive.begin();
    const light = await attempt(drive, cell, Math.max(1, Math.round(few / cell.room)));
    return { light, most: holds(light) ? await climb(drive, cell, light, nearness) : light };
  } finally {
    drive.end();
  }
}
