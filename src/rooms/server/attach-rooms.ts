import { randomBytes } from 'node:crypto';
import type { IncomingMessage, Server, ServerResponse } from 'node:http';
import type { Duplex } from 'node:stream';
import { createConnectionLimiter } from 'threepoint-http/connection-limiter';
import { createRouter, noPage } from 'threepoint-http/router';
import { createSitePolicy, type SitePolicy } from 'threepoint-http/site-policy';
import { peopleKind, peoplePolicy } from '../room/people-policy';
import type { RoomKinds } from './hosting/room-kinds';
import { createRelay } from './relay';
import { type RelayConfiguration, relayConfigurationFrom } from './settings/relay-configuration';

export interface AttachRoomsOptions extends Partial<Omit<RelayConfiguration, 'secret' | 'hosts' | 'host'>> {
  /** Signs the passes; at least 32 characters, the same in all processes. Default: a new one in every process. */
  readonly secret?: string;
  /** The path below which the rooms are, for example '/bodies'; pages join at that address. Default: none. */
  readonly path?: string;
  /** The most people of a room without a game, 1 to 16. Default: 16. */
  readonly seats?: number;
  /** Games, by name; each creates the match policy of a room. Default: none, rooms are just people. */
  readonly games?: RoomKinds;
}

/** Rooms on a server. */
export interface AttachedRooms {
  /** The number of rooms and of the people in them. */
  readonly census: { readonly rooms: number; readonly players: number; readonly spectators: number };
  /** Disconnects everybody and takes the rooms off the server, which stays open. */
  close(): Promise<void>;
}

/** The addresses of the rooms; the rest of the server's is its own. */
const ours = /^\/(api\/(rooms|avatars|voices)|relay)([/?]|$)/;

/**
 * Adds rooms to an HTTP server: that of node:http, the return value of Express's `listen`, or Fastify's `server`. Their
 * addresses are `/api/rooms`, `/api/avatars`, `/api/voices` and the WebSockets at `/relay`; all others stay the
 * server's. Pages of the server's own origin may join, and those of `origins`.
 *
 * @example
 * const server = createServer(app);
 * attachRooms(server, { origins: ['https://example.org'] });
 * server.listen(8080);
 */
export function attachRooms(httpServer: Server, options: AttachRoomsOptions = {}): AttachedRooms {
  const { secret = randomBytes(32).toString('base64url'), path = '', seats, games, ...settings } = options;
  if (secret.length < 32) throw new RangeError(`A secret needs at least 32 characters; this one has ${secret.length}.`);
  if (!/^(\/[\w-]+)*$/.test(path))
    throw new RangeError(`The path must be like '/bodies', not ${JSON.stringify(path)}.`);
  const configuration: RelayConfiguration = { ...relayConfigurationFrom({}), ...settings };
  const { connectionsPerAddress: perAddress, trustProxy } = configuration;
  const relay = createRelay(
    configuration,
    secret,
    createConnectionLimiter({ perAddress, behindProxy: trustProxy }),
    new Map([[peopleKind, () => peoplePolicy(seats)], ...(games ?? [])]),
  );
  const site = originsOnly(configuration);
  const router = createRouter([relay.service], noPage, site);

  /** Returns whether the address is the rooms', and takes the path off it. */
  function takesUrl(request: IncomingMessage): boolean {
    const { url = '' } = request;
    if (!url.startsWith(path) || !ours.test(url.slice(path.length))) return false;
    request.url = url.slice(path.length);
    return true;
  }

  // The server's own listener would answer 404: it receives the other requests alone.
  const listeners = httpServer.listeners('request') as ((...request: unknown[]) => void)[];
  const onRequest = (request: IncomingMessage, response: ServerResponse): void => {
    if (!takesUrl(request)) for (const listener of listeners) listener.call(httpServer, request, response);
    else if (allowOrigin(request, response, site)) router(request, response);
  };
  const onUpgrade = (request: IncomingMessage, socket: Duplex, head: Buffer): void => {
    if (takesUrl(request)) {
      socket.on('error', () => socket.destroy());
      if (relay.upgrade(request, socket, head)) return;
    }
    // Nobody else would ever answer.
    if (httpServer.listenerCount('upgrade') === 1) socket.destroy();
  };
  httpServer.removeAllListeners('request');
  httpServer.on('request', onRequest);
  httpServer.on('upgrade', onUpgrade);
  return {
    get census() {
      return relay.census;
    },
    async close() {
      httpServer.off('upgrade', onUpgrade);
      httpServer.off('request', onRequest);
      for (const listener of listeners) httpServer.on('request', listener);
      await relay.close();
    },
  };
}

/** The names of the server are its owner's business; the origins of pages are checked. */
const originsOnly = ({ origins, trustProxy }: RelayConfiguration): SitePolicy => ({
  ...createSitePolicy({ origins, hosts: [], trustProxy }),
  refusalOfHost: () => null,
});

/**
 * Lets pages of other origins read the answers, where they may use the rooms. Answers a preflight request; returns
 * whether the request itself is still to be answered.
 */
function allowOrigin(request: IncomingMessage, response: ServerResponse, site: SitePolicy): boolean {
  const { origin } = request.headers;
  const allowed = origin !== undefined && site.refusalOfOrigin(request) === null;
  if (allowed) {
    response.setHeader('access-control-allow-origin', origin);
    response.setHeader('vary', 'origin');
  }
  if (request.method !== 'OPTIONS') return true;
  if (allowed) {
    response.setHeader('access-control-allow-methods', 'GET, POST, PUT');
    response.setHeader('access-control-allow-headers', 'content-type, authorization');
    response.setHeader('access-control-max-age', '600');
  }
  response.writeHead(204).end();
  return false;
}
