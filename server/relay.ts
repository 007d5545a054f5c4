import { randomBytes } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname } from 'node:path';
import { createAdapter } from '@socket.io/redis-adapter';
import { pino } from 'pino';
import { Adapter } from 'socket.io-adapter';
import type { Door } from './door';
import type { RoomListing } from './hosted-rooms';
import type { Service } from './http/router';
import { connectRedis, connectRedisPatiently, createOwnLobby, createRedisLobby } from './lobby';
import type { RelayConfiguration } from './relay-configuration';
import { createRelayMetrics, type RelayCensus } from './relay-metrics';
import { createRelayRoutes } from './relay-routes';
import { createRelayTransport } from './relay-transport';
import { createRoomTokens } from './room-tokens';
import { createSocketHost, type SocketHost } from './socket-host';
import type { UpgradeListener } from './web-server';

/** A relay for a server: its sockets and its part of the HTTP. */
export interface Relay {
  readonly host: SocketHost;
  readonly census: RelayCensus;
  readonly service: Service;
  readonly upgrade: UpgradeListener;
  /** Says farewell and closes; the server itself is its owner's. */
  close(): Promise<void>;
}

const lobbyEveryMs = 1000;
/** What the processes of a fleet tell each other: that a room is to end. */
const endEvent = 'end-room';

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

/** Starts a relay; `secret` signs the tokens, `door` counts the connections of its server. */
export function createRelay(configuration: RelayConfiguration, secret: string, door: Door): Relay {
  const log = pino({ level: configuration.logLevel, base: { node: process.pid } });
  const now = (): number => performance.now() / 1000;
  const node = randomBytes(6).toString('hex');
  const tokens = createRoomTokens(secret, () => Date.now() / 1000);
  const census = (): RelayCensus => ({
    ...host.census,
    sockets: transport.sockets,
    connections: door.open,
    refusedConnections: door.refused,
  });
  const metrics = createRelayMetrics(census);
  const transport = createRelayTransport(configuration, { log, metrics });
  const host = createSocketHost(transport, { configuration, tokens, log, metrics, now });
  const connections = configuration.redisUrl
    ? {
        own: connectRedis(configuration.redisUrl, log),
        told: connectRedisPatiently(configuration.redisUrl, log),
        heard: connectRedisPatiently(configuration.redisUrl, log),
      }
    : null;
  const lobby = connections ? createRedisLobby(connections.own, node, log) : createOwnLobby();

  // Poses stay in the process that has the room; what Redis carries is the lobby alone.
  if (connections) {
    const shared = createAdapter(connections.told, connections.heard);
    // socket.io calls it with new, and takes what it returns.
    const adapterFor = function adapterFor(namespace: ConstructorParameters<typeof Adapter>[0]) {
      return namespace.name === lobbyNamespace ? shared(namespace) : new Adapter(namespace);
    };
    host.io.adapter(adapterFor as never);
  }
  const hall = host.io.of(lobbyNamespace);
  hall.on('connection', (socket) => {
    void lobby.list().then((all) => socket.emit('rooms', all));
    socket.onAny(() => socket.disconnect(true));
  });

  hall.on(endEvent, (room: string) => void host.end(room));
  /** Alone, or with Redis out of reach, this process is all there is. */
  const reachesAll = (): boolean => connections?.told.status === 'ready';
  const endRoom = (room: string): void => {
    host.end(room);
    if (reachesAll()) hall.serverSideEmit(endEvent, room);
  };

  let told = '';
  const timer = setInterval(() => {
    const rooms: readonly RoomListing[] = host.rooms;
    lobby.publish(rooms);
    const text = JSON.stringify(rooms);
    if (text === told) return;
    told = text;
    // What cannot be told now is told with the next change: without Redis nothing piles up.
    (reachesAll() ? hall : hall.local).emit('node', { node, rooms });
  }, lobbyEveryMs);

  const service = createRelayRoutes({
    configuration,
    tokens,
    lobby,
    census,
    metrics,
    log,
    endRoom,
    redis: connections?.own ?? null,
  });
  return {
    host,
    get census() {
      return census();
    },
    service,
    upgrade: transport.upgrade,
    async close() {
      clearInterval(timer);
      await host.close();
      await lobby.close();
      connections?.told.disconnect();
      connections?.heard.disconnect();
      metrics.close();
    },
  };
}

/** Where a page hears of rooms that open, fill and close, in whichever process. */
export const lobbyNamespace = '/lobby';
