import type { Logger } from 'pino';
import type { RoomKinds } from 'threepoint-rooms/room';
import type { RoomTokens } from './access/room-tokens';
import type { RelayConfiguration } from './settings/relay-configuration';
import type { RelayMetrics } from './settings/relay-metrics';

/** What the parts of a relay share. */
export interface RelayContext {
  readonly configuration: RelayConfiguration;
  /** The games of the server. */
  readonly kinds: RoomKinds;
  readonly tokens: RoomTokens;
  readonly log: Logger;
  readonly metrics: RelayMetrics;
  /** Seconds, monotonic: the clock of all rooms. */
  readonly now: () => number;
  /** Starts regular work; an exception in it is a line of the log. `what`: its name there. */
  repeat(what: string, everyMs: number, work: () => void): NodeJS.Timeout;
}
