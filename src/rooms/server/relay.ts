import { randomBytes } from 'node:crypto';
import { type Logger, pino } from 'pino';
import type { Service } from 'threepoint-http/router';
import type { UpgradeListener } from 'threepoint-http/web-server';
import { RoomTokens } from './access/room-tokens';
import { AvatarRoutes } from './avatars/avatar-routes';
import { AvatarStore } from './avatars/avatar-store';
import type { ConnectionCounts } from './connection-counts';
import type { RoomKinds } from './hosting/room-kinds';
import { createSocketHost, type SocketHost } from './hosting/socket-host';
import { createOwnLobby, createRedisLobby } from './lobby/lobby';
import { LobbyPublisher } from './lobby/lobby-publisher';
import { connectRedis, connectRedisPatiently } from './lobby/redis-connection';
import { RelayRoutes } from './relay-routes';
import type { RelayConfiguration } from './settings/relay-configuration';
import { createRelayMetrics, type RelayCensus } from './settings/relay-metrics';
import { createRelayTransport } from './sockets/relay-transport';
import { VoiceRoutes } from './voices/voice-routes';

/** The relay of a server: its sockets and its HTTP service. */
export interface Relay {
  readonly host: SocketHost;
  readonly avatars: AvatarStore;
  readonly census: RelayCensus;
  readonly service: Service;
  readonly upgrade: UpgradeListener;
  /** Disconnects all clients and stops the relay; the HTTP server stays open. */
  close(): Promise<void>;
}

/** Returns the time in seconds since 1970. */
const unixTime = (): number => Date.now() / 1000;
/** Interval at which avatars that nobody wears are deleted [ms]. */
const sweepMs = 1000;

/** Connects to the Redis that several processes share; null: a single process. */
function connectFleet({ redisUrl }: RelayConfiguration, log: Logger) {
  if (!redisUrl) return null;
  return {
    own: connectRedis(redisUrl, log),
    publisher: connectRedisPatiently(redisUrl, log),
    subscriber: connectRedisPatiently(redisUrl, log),
  };
}

/** Starts a relay. `secret` signs the tokens; `connections` are those of the HTTP server; `kinds` are the games. */
export function createRelay(
  configuration: RelayConfiguration,
  secret: string,
  connections: ConnectionCounts,
  kinds: RoomKinds,
): Relay {
  const log = pino({ level: configuration.logLevel, base: { node: process.pid } });
  const now = (): number => performance.now() / 1000;
  const node = randomBytes(6).toString('hex');
  const tokens = new RoomTokens(secret, unixTime);
  const census = (): RelayCensus => ({
    ...host.census,
    sockets: transport.sockets,
    connections: connections.open,
    refusedConnections: connections.refused,
    avatars: avatars.count,
    avatarBytes: avatars.bytes,
  });
  const metrics = createRelayMetrics(census);
  const transport = createRelayTransport(configuration, { log, metrics, now });
  const host = createSocketHost(transport, { configuration, kinds, tokens, log, metrics, now });
  const avatarOf = (room: string, identity: string) => host.room(room)?.avatarOf(identity) ?? null;
  const avatars = new AvatarStore({ maxBytes: configuration.avatarMegabytes * 2 ** 20, avatarOf, now });
  const sweeping = setInterval(() => avatars.sweep(), sweepMs).unref();
  const fleet = connectFleet(configuration, log);
  const lobby = fleet ? createRedisLobby(fleet.own, node, log) : createOwnLobby();
  const lobbyPublisher = new LobbyPublisher({
    io: host.io,
    lobby,
    node,
    channel: fleet,
    rooms: () => host.rooms,
    endRoom: (room) => void host.end(room),
  });
  const service = new RelayRoutes({
    configuration,
    kinds,
    tokens,
    lobby,
    census,
    metrics,
    log,
    endRoom: (room) => lobbyPublisher.endRoom(room),
    redis: fleet?.own ?? null,
    avatars: new AvatarRoutes({
      ...{ configuration, store: avatars, tokens, metrics },
      isSeated: (room, identity) => avatarOf(room, identity) !== null,
    }),
    voices: new VoiceRoutes({ voices: configuration.voices, tokens, now: unixTime }),
  });
  return {
    host,
    avatars,
    get census() {
      return census();
    },
    service,
    upgrade: transport.upgrade,
    async close() {
      clearInterval(sweeping);
      avatars.clear();
      lobbyPublisher.close();
      await host.close();
      await lobby.close();
      fleet?.publisher.disconnect();
      fleet?.subscriber.disconnect();
      metrics.close();
    },
  };
}
