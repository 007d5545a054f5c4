import { Counter, collectDefaultMetrics, Gauge, Histogram, Registry } from 'prom-client';

export interface RelayMetrics {
  readonly registry: Registry;
  readonly counts: RelayCounts;
  /** Duration of a tick of all rooms [s]. */
  readonly tick: Histogram;
  kicked(reason: string): void;
  refused(what: string, reason: string): void;
  close(): void;
}

/** Numbers of rooms and of their members in this process. */
export interface HostCensus {
  readonly rooms: number;
  readonly players: number;
  readonly bots: number;
  readonly spectators: number;
}

/** The connections of an HTTP server. */
export interface ConnectionCounts {
  /** Open connections, silent ones included. */
  readonly open: number;
  /** Connections refused since the start because their address had too many. */
  readonly refused: number;
}

/** The gauges of a relay, read with the metrics. */
export interface RelayCensus extends HostCensus {
  /** Open WebSockets, silent ones included. */
  readonly sockets: number;
  /** Open connections of any kind, silent ones included. */
  readonly connections: number;
  /** Connections refused since the start, because their address had too many. */
  readonly refusedConnections: number;
  readonly avatars: number;
  /** Their bytes, uploads under way included. */
  readonly avatarBytes: number;
}

/** The counters of the hot path: the name of each metric, and its help. */
const countHelp = {
  posesIn: ['poses_in', 'Pose packets received.'],
  posesIgnored: ['poses_ignored', 'Pose packets that were old, implausibly fast, or beyond the limit.'],
  framesOut: ['frames_out', 'Frames of poses sent, one for each client.'],
  framesDropped: ['frames_dropped', 'Frames of poses that were dropped because a connection was busy.'],
  messagesIn: ['messages_in', 'Control messages received.'],
  bytesIn: ['pose_bytes_in', 'Bytes of pose packets received.'],
  bytesOut: ['frame_bytes_out', 'Bytes of frames of poses sent.'],
} as const;

/** The counters of `countHelp`: plain numbers, which the metrics read on request. */
export type RelayCounts = Record<keyof typeof countHelp, number>;

const gaugeHelp = {
  rooms: 'Rooms in this process.',
  players: 'People on seats, held seats included.',
  bots: 'Bots on seats.',
  spectators: 'Spectators.',
  sockets: 'Open WebSockets, silent ones included.',
  connections: 'Open connections of any kind, silent ones included.',
  avatars: 'Avatar files in the store.',
  avatarBytes: 'Bytes of avatars in the store, uploads under way included.',
} as const satisfies Partial<Record<keyof RelayCensus, string>>;

const keysOf = <T extends object>(of: T): (keyof T)[] => Object.keys(of) as (keyof T)[];

/** Adds a counter that is read from `count` on each request for the metrics. */
function addCounter(registry: Registry, name: string, help: string, count: () => number): void {
  new Counter({
    name: `threepoint_${name}_total`,
    help,
    registers: [registry],
    collect() {
      this.reset();
      this.inc(count());
    },
  });
}

function addGauge(registry: Registry, name: string, help: string, value: () => number): void {
  new Gauge({
    name: `threepoint_${name}`,
    help,
    registers: [registry],
    collect() {
      this.set(value());
    },
  });
}

export function createRelayMetrics(census: () => RelayCensus): RelayMetrics {
  const registry = new Registry();
  collectDefaultMetrics({ register: registry, prefix: 'threepoint_' });
  const registers = [registry];
  const counts = Object.fromEntries(keysOf(countHelp).map((key) => [key, 0])) as RelayCounts;
  for (const key of keysOf(countHelp)) {
    const [name, help] = countHelp[key];
    addCounter(registry, name, help, () => counts[key]);
  }
  for (const key of keysOf(gaugeHelp)) addGauge(registry, key, gaugeHelp[key], () => census()[key]);
  const rejectedHelp = 'Connections refused because their address had too many.';
  addCounter(registry, 'connections_refused', rejectedHelp, () => census().refusedConnections);
  const kicks = new Counter({
    name: 'threepoint_kicks_total',
    help: 'Clients that were disconnected, by reason.',
    labelNames: ['reason'],
    registers,
  });
  const rejections = new Counter({
    name: 'threepoint_refusals_total',
    help: 'Requests that rooms refused, by reason.',
    labelNames: ['what', 'reason'],
    registers,
  });
  const tick = new Histogram({
    name: 'threepoint_tick_seconds',
    help: 'Time that one tick of all rooms took.',
    buckets: [0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1],
    registers,
  });
  return {
    registry,
    counts,
    tick,
    kicked: (reason) => kicks.inc({ reason }),
    refused: (what, reason) => rejections.inc({ what, reason }),
    close: () => registry.clear(),
  };
}
