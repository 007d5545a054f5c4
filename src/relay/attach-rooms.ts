import { randomBytes } from 'node:crypto';
import type { IncomingMessage, Server, ServerResponse } from 'node:http';
import type { Duplex } from 'node:stream';
import {
  answering,
  createRouter,
  createSitePolicy,
  followResponse,
  handingOver,
  ignoreOffer,
  noPage,
  parseRequestTarget,
  type SitePolicy,
  sendResponse,
} from 'threepoint-http';
import { peopleKind, peopleRoomKind } from 'threepoint-rooms/host';
import type { RoomKind, RoomKinds } from 'threepoint-rooms/room';
import { createRelay } from './relay';
import { type RelayConfiguration, relayConfigurationFrom } from './settings/relay-configuration';
import type { ConnectionCounts } from './settings/relay-metrics';

export interface AttachRoomsOptions extends Partial<Omit<RelayConfiguration, 'secret' | 'host'>> {
  /**
   * Signs the passes; at least 32 characters, the same in all processes. Default, as for null: a new one in every
   * process.
   */
  readonly secret?: string | null;
  /** The path below which the rooms are, for example '/bodies'; pages join at that address. Default: none. */
  readonly path?: string;
  /** The most people of a room without a game, 1 to 16. Default: 16. */
  readonly seats?: number;
  /** Games, by name. Default: none, rooms are just people. */
  readonly games?: RoomKinds;
  /** The names of the server. Default: 'any', the Host is not checked. */
  readonly hosts?: RelayConfiguration['hosts'];
  /** Whether the rooms also answer `/healthz` and `/metrics`. Default: false. */
  readonly monitoring?: boolean;
  /** Counts of the server's connections, for `/healthz` and `/metrics`. Default: zeros. */
  readonly connections?: ConnectionCounts;
}

/** Rooms on a server. */
export interface AttachedRooms {
  /** The number of rooms and of the people in them. */
  readonly census: { readonly rooms: number; readonly players: number; readonly spectators: number };
  /** Methods and paths of the rooms' addresses, below `path`; ":name" stands for one segment. */
  readonly routes: readonly { readonly method: string; readonly path: string }[];
  /** Disconnects everybody and takes the rooms off the server, which stays open. */
  close(): Promise<void>;
}

/** The addresses of the rooms; the rest of the server's is its own. */
const roomAddresses = /^\/(api\/(rooms|avatars|voices)|relay)(\/|$)/;
const operationAddresses = /^\/(healthz|metrics)$/;

type Listener = (...event: unknown[]) => void;

/**
 * Replaces all listeners of an event by one, which may pass the event on to them: `passOn` returns whether there are
 * others. Returns what undoes it.
 */
function interceptEvent(
  server: Server,
  event: 'request' | 'upgrade',
  listener: (passOn: (...event: unknown[]) => boolean) => Listener,
): () => void {
  const others = server.listeners(event) as Listener[];
  const own = listener((...values) => {
    for (const other of others) other.apply(server, values);
    return server.listenerCount(event) > 1 || others.length > 0;
  });
  server.removeAllListeners(event);
  server.on(event, own);
  return () => {
    server.off(event, own);
    for (const other of others) server.on(event, other);
  };
}

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
  const { path = '', seats, games, monitoring, ...settings } = options;
  const secret = options.secret ?? randomBytes(32).toString('base64url');
  const { connections = { open: 0, refused: 0 } } = settings;
  if (secret.length < 32) throw new RangeError(`A secret needs at least 32 characters; this one has ${secret.length}.`);
  if (!/^(\/[\w-]+)*$/.test(path))
    throw new RangeError(`The path must be like '/bodies', not ${JSON.stringify(path)}.`);
  const configuration: RelayConfiguration = { ...relayConfigurationFrom({}), hosts: 'any', ...settings };
  const kinds = new Map<string, RoomKind>([[peopleKind, peopleRoomKind(seats)], ...(games ?? [])]);
  const relay = createRelay(configuration, secret, connections, kinds);
  const site = createSitePolicy(configuration);
  const router = createRouter([relay.service], noPage, site);
  const { onError } = relay.service;
  const answer = answering((request, response) => {
    if (allowOrigin(request, response, site)) router(request, response);
  }, onError);

  /** Returns whether the address is the rooms', and takes the path off it. */
  function takeOwnUrl(request: IncomingMessage): boolean {
    const target = parseRequestTarget(request.url);
    if (!target?.path.startsWith(path)) return false;
    const own = target.path.slice(path.length);
    if (!roomAddresses.test(own) && !(monitoring && operationAddresses.test(own))) return false;
    if (path !== '') request.url = target.query.size > 0 ? `${own}?${target.query}` : own;
    return true;
  }

  const restore = [
    // The server's own listener would answer 404: it receives the other requests alone.
    interceptEvent(httpServer, 'request', (passOn) => (request, response) => {
      const [asked, answered] = [request as IncomingMessage, response as ServerResponse];
      followResponse(asked, answered);
      if (takeOwnUrl(asked)) answer(asked, answered);
      else passOn(asked, answered);
    }),
    interceptEvent(httpServer, 'upgrade', (passOn) => (request, socket, head) => {
      const [asked, connection] = [request as IncomingMessage, socket as Duplex];
      const { url } = asked;
      // Without another listener, the offer is to be ignored: this listener made Node hand over the connection.
      const ignore = handingOver(() => ignoreOffer(httpServer, asked, connection), onError);
      const passOnOffer = (): void => {
        if (!passOn(asked, connection, head)) ignore(asked, connection, head as Buffer);
      };
      const answerOwn = handingOver((...offer) => {
        if (relay.upgrade(...offer)) return;
        asked.url = url;
        passOnOffer();
      }, onError);
      if (takeOwnUrl(asked)) answerOwn(asked, connection, head as Buffer);
      else passOnOffer();
    }),
  ];
  return {
    get census() {
      return relay.census;
    },
    routes: relay.service.routes,
    async close() {
      for (const undo of restore) undo();
      await relay.close();
    },
  };
}

/**
 * Lets pages of other origins read the answers, where they may use the rooms. Answers their preflight requests; returns
 * whether the request itself is still to be answered.
 */
function allowOrigin(request: IncomingMessage, response: ServerResponse, site: SitePolicy): boolean {
  const { origin } = request.headers;
  if (origin === undefined || site.checkOrigin(request) !== null) return true;
  response.setHeader('access-control-allow-origin', origin);
  response.setHeader('vary', 'origin');
  if (request.method !== 'OPTIONS' || site.checkHost(request) !== null) return true;
  const headers = {
    'access-control-allow-methods': 'GET, POST, PUT',
    'access-control-allow-headers': 'content-type, authorization',
    'access-control-max-age': '600',
  };
  sendResponse(request, response, { status: 204, headers });
  return false;
}
