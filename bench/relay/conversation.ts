/** Messages between the processes of the relay bench. */

export type RelaySort = 'ours' | 'plain';

/** What is searched for: the most clients of one relay, in rooms of one size at one rate. */
export interface Cell {
  readonly relay: RelaySort;
  /** Avatars in each room. */
  readonly room: number;
  /** Poses that each avatar sends per second. */
  readonly hz: number;
}

/** The first message to the clients: the relay to connect to. */
export interface Meeting extends Cell {
  readonly port: number;
  /** Signs the passes that ours asks for. */
  readonly secret: string;
  /** Everyone is ready for a round of an hour, which runs as long as they are there. */
  readonly plays?: boolean;
}

/**
 * To the clients, again and again: play in this many rooms, others who have come before are silent, and say how it
 * went.
 */
export interface Load {
  readonly rooms: number;
  readonly warmUpSeconds: number;
  readonly seconds: number;
}

/** Figures of the poses that were sent in the measured seconds. */
export interface PoseLatencies {
  /** From a pose's sending to its arrival at one of the others [ms]: the median over the parts of the measurement. */
  readonly p50Ms: number;
  readonly p99Ms: number;
  readonly sent: number;
  /** Poses of others that arrived, over all clients. */
  readonly delivered: number;
  /** Payload of the WebSocket messages that carry poses [bytes]. */
  readonly bytesUp: number;
  readonly bytesDown: number;
  readonly seconds: number;
  /** Share of a core that the clients themselves took. */
  readonly clientLoad: number;
}

/** To the clients: all leave their rooms and give up their seats. */
export type Farewell = 'leave';

/** From the clients: all are there, and the seconds that are measured begin; how it went. */
export type ClientAnswer = 'measuring' | PoseLatencies;

/** From a relay: first where it listens, then on each message what it took so far. */
export interface RelayGreeting {
  readonly port: number;
}
/** See RelayGreeting. */
export interface RelayUsage {
  readonly cpuMicroseconds: number;
  readonly rssBytes: number;
}

/** Greets the bench, and answers it from then on. */
export function answerAsRelay(port: number): void {
  process.on('message', () => {
    const { user, system } = process.cpuUsage();
    process.send?.({ cpuMicroseconds: user + system, rssBytes: process.memoryUsage.rss() } satisfies RelayUsage);
  });
  process.send?.({ port } satisfies RelayGreeting);
}
