/** What the processes of the relay bench tell each other. */

export type RelaySort = 'ours' | 'plain';

/** To the clients: play this many rooms of people and say how it went. */
export interface Load {
  readonly relay: RelaySort;
  readonly port: number;
  /** Avatars in each room. */
  readonly room: number;
  readonly rooms: number;
  /** Poses that each avatar sends per second. */
  readonly hz: number;
  readonly warmUpSeconds: number;
  readonly seconds: number;
  /** One for each client; ours asks for them. */
  readonly tokens: readonly string[];
}

/** Of the measured seconds alone. */
export interface Heard {
  /** From a pose's sending to its arrival at one of the others [ms]: the median over the seconds of the measurement. */
  readonly p50Ms: number;
  readonly p99Ms: number;
  readonly sent: number;
  /** Poses of others that arrived, over all clients. */
  readonly delivered: number;
  /** Payload of WebSocket messages [bytes]. */
  readonly bytesUp: number;
  readonly bytesDown: number;
  readonly seconds: number;
  /** Share of a core that the clients themselves took. */
  readonly clientLoad: number;
}

/** To a relay: `cpu` asks for its CPU time so far. */
export type RelayAnswer = { readonly port: number } | { readonly cpuMicroseconds: number; readonly rssBytes: number };
