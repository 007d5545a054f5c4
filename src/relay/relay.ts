import { randomBytes } from 'node:crypto';
import { type Logger, pino } from 'pino';
import type { Server } from 'socket.io';
import { guarded, type Service, type UpgradeListener } from 'threepoint-http';
import type { RoomKinds } from 'threepoint-rooms/room';
import { RoomTokens } from './access/room-tokens';
import { avatarRoutes } from './avatars/avatar-routes';
import { AvatarStore } from './avatars/avatar-store';
import { RoomRegistry } from './hosting/room-registry';
import { hostSockets } from './hosting/socket-host';
import { createLobby } from './lobby/lobby';
import { LobbyPublisher } from './lobby/lobby-publisher';
import { connectRedis, connectRedisPatiently } from './lobby/redis-connection';
import type { RelayContext } from './relay-context';
import { createRelayService } from './relay-service';
import type { RelayConfiguration } from './settings/relay-configuration';
import { type ConnectionCounts, createRelayMetrics, type RelayCensus } from './settings/relay-metrics';
import { createRelayTransport } from './sockets/relay-transport';
import { voiceRoute } from './voices/voice-routes';

/** The relay of a server: its sockets and its HTTP service. */
interface Relay {
  readonly io: Server;
  readonly rooms: RoomRegistry;
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
    ...rooms.census,
    sockets: transport.sockets,
    connections: connections.open,
    refusedConnections: connections.refused,
    avatars: avatars.count,
    avatarBytes: avatars.bytes,
  });
  const metrics = createRelayMetrics(census);
  const repeat: RelayContext['repeat'] = (what, everyMs, work) =>
    setInterval(
      guarded(work, (error) => log.error({ error: String(error) }, `${what} failed`)),
      everyMs,
    );
  const context: RelayContext = { configuration, kinds, tokens, log, metrics, now, repeat };
  const transport = createRelayTransport(context);
  const { io } = transport;
  const rooms = new RoomRegistry(context, io);
  const closeSockets = hostSockets(transport, rooms, context);
  const avatarOf = (room: string, identity: string) => rooms.get(room)?.room.avatarOf(identity) ?? null;
  const avatars = new AvatarStore({ maxBytes: configuration.avatarMegabytes * 2 ** 20, avatarOf, now });
  const sweeping = repeat('the sweep of avatars', sweepMs, () => avatars.sweep());
  const fleet = connectFleet(configuration, log);
  const lobby = createLobby(fleet?.own ?? null, node, log);
  const lobbyPublisher = new LobbyPublisher({ io, lobby, node, channel: fleet, rooms, repeat });
  const service = createRelayService(context, {
    lobby,
    census,
    endRoom: (room) => lobbyPublisher.endRoom(room),
    redis: fleet?.own ?? null,
    roomRoutes: [
      ...avatarRoutes(context, avatars, (room, identity) => avatarOf(room, identity) !== null),
      voiceRoute(configuration.voices, tokens, unixTime),
    ],
  });
  return {
    io,
    rooms,
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
      await closeSockets();
      fleet?.own.disconnect();
      fleet?.publisher.disconnect();
      fleet?.subscriber.disconnect();
      metrics.close();
    },
  };
}
