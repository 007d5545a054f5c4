import { randomBytes } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname } from 'node:path';
import { type Logger, pino } from 'pino';
import type { ConnectionLimiter } from 'threepoint-http/connection-limiter';
import type { Service } from 'threepoint-http/router';
import type { UpgradeListener } from 'threepoint-http/web-server';
import { AvatarRoutes } from './avatar-routes';
import { AvatarStore } from './avatar-store';
import { connectRedis, connectRedisPatiently, createOwnLobby, createRedisLobby } from './lobby';
import { LobbyHall } from './lobby-hall';
import type { RelayConfiguration } from './relay-configuration';
import { createRelayMetrics, type RelayCensus } from './relay-metrics';
import { RelayRoutes } from './relay-routes';
import { createRelayTransport } from './relay-transport';
import type { RoomKinds } from './room-kinds';
import { createRoomTokens } from './room-tokens';
import { createSocketHost, type SocketHost } from './socket-host';
import { VoiceRoutes } from './voice-routes';

/** A relay for a server: its sockets and its part of the HTTP. */
export interface Relay {
  readonly host: SocketHost;
  readonly avatars: AvatarStore;
  readonly census: RelayCensus;
  readonly service: Service;
  readonly upgrade: UpgradeListener;
  /** Says farewell and closes; the server itself is its owner's. */
  close(): Promise<void>;
}

/** Seconds since 1970. */
const unixTime = (): number => Date.now() / 1000;
/** How often avatars that no one has on any more are forgotten [ms]. */
const sweepMs = 1000;

/** A secret kept in a file, so that tokens outlive a restart. */
export function secretIn(path: string): string {
  if (existsSync(path)) {
    const kept = readFileSync(path, 'utf8').trim();
    if (kept.length >= 32) return kept;
  }
  const secret = randomBytes(32).toString('base64url');
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(path, `${secret}\n`, { mode: 0o600 });
  return secret;
}

/** Connections to the Redis of a fleet; null: this process is alone. */
function connectFleet({ redisUrl }: RelayConfiguration, log: Logger) {
  if (!redisUrl) return null;
  return {
    own: connectRedis(redisUrl, log),
    told: connectRedisPatiently(redisUrl, log),
    heard: connectRedisPatiently(redisUrl, log),
  };
}

/** Starts a relay; `secret` signs the tokens, `connectionLimiter` counts the connections of its server, `kinds` are the games of its rooms. */
export function createRelay(
  configuration: RelayConfiguration,
  secret: string,
  connectionLimiter: ConnectionLimiter,
  kinds: RoomKinds,
): Relay {
  const log = pino({ level: configuration.logLevel, base: { node: process.pid } });
  const now = (): number => performance.now() / 1000;
  const node = randomBytes(6).toString('hex');
  const tokens = createRoomTokens(secret, unixTime);
  const census = (): RelayCensus => ({
    ...host.census,
    sockets: transport.sockets,
    connections: connectionLimiter.open,
    refusedConnections: connectionLimiter.refused,
    avatars: avatars.count,
    avatarBytes: avatars.bytes,
  });
  const metrics = createRelayMetrics(census);
  const transport = createRelayTransport(configuration, { log, metrics, now });
  const host = createSocketHost(transport, { configuration, kinds, tokens, log, metrics, now });
  const wornBy = (room: string, identity: string) => host.room(room)?.wornBy(identity) ?? null;
  const avatars = new AvatarStore({ mostBytes: configuration.avatarMegabytes * 2 ** 20, wornBy, now });
  const sweeping = setInterval(() => avatars.sweep(), sweepMs).unref();
  const fleet = connectFleet(configuration, log);
  const lobby = fleet ? createRedisLobby(fleet.own, node, log) : createOwnLobby();
  const hall = new LobbyHall({
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
    endRoom: (room) => hall.endRoom(room),
    redis: fleet?.own ?? null,
    avatars: new AvatarRoutes({
      ...{ configuration, store: avatars, tokens, metrics },
      isSeated: (room, identity) => wornBy(room, identity) !== null,
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
      hall.close();
      await host.close();
      await lobby.close();
      fleet?.told.disconnect();
      fleet?.heard.disconnect();
      metrics.close();
    },
  };
}
