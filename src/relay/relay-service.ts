import { randomBytes } from 'node:crypto';
import type { IncomingMessage } from 'node:http';
import type { Redis } from 'ioredis';
import { checked } from 'threepoint/core';
import {
  AdminGuard,
  type Call,
  clientAddressOf,
  HttpError,
  type HttpResponse,
  jsonOf,
  jsonResponse,
  type Route,
  type Service,
} from 'threepoint-http';
import type { RoomKind, RoomKinds } from 'threepoint-rooms/room';
import * as v from 'valibot';
import { createJoinLimit } from './access/join-limit';
import { allowedTerms, assignedRoomName, roomName } from './access/room-tokens';
import type { RoomListing } from './hosting/room-registry';
import type { Lobby } from './lobby/lobby';
import type { RelayContext } from './relay-context';
import type { RelayCensus } from './settings/relay-metrics';
import { relayPath } from './sockets/relay-transport';

interface RelayServiceOptions {
  readonly lobby: Lobby;
  readonly census: () => RelayCensus;
  /** Ends a room in whichever process has it. */
  readonly endRoom: (room: string) => void;
  /** Stores the join counts of all processes; null: a single process. */
  readonly redis: Redis | null;
  readonly roomRoutes: readonly Route<'client'>[];
}

const longestBody = 4096;

const room = v.pipe(
  v.string('expected the name of a room'),
  v.regex(roomName, 'expected lower-case letters, digits and hyphens, at most 32, beginning with a letter or digit'),
);
const endRequest = v.strictObject({
  room: v.union([room, v.pipe(v.string(), v.regex(assignedRoomName))], 'expected the name of a room'),
});

/** Returns the schemas of requests for these games. */
function roomRequests(kinds: RoomKinds) {
  const names = [...kinds.keys()];
  const expectedNames = `expected one of ${names.join(', ')}`;
  const tokenRequestOf = ([kind, { openTerms }]: readonly [string, RoomKind]) =>
    v.strictObject({
      room,
      kind: v.literal(kind),
      /** An earlier token of the same person, to be renewed. */
      token: v.optional(v.pipe(v.string('expected text'), v.maxLength(1024, 'expected at most 1024 characters'))),
      /** The terms, if this person is the first in the room. */
      terms: v.optional(openTerms),
    });
  return {
    kind: v.strictObject({ kind: v.picklist(names, expectedNames) }),
    token: v.variant('kind', [...kinds].map(tokenRequestOf), expectedNames),
  };
}

/** Returns a name that cannot be guessed: it is the key to the room. */
const newRoomName = (): string => randomBytes(6).toString('hex');

const waitingOrder = { ready: 0, over: 1, running: 2 } as const;

/** Sorts rooms for matchmaking: waiting before playing, then fuller before emptier. */
const byPreference = (a: RoomListing, b: RoomListing): number =>
  waitingOrder[a.phase] - waitingOrder[b.phase] || b.players - a.players || a.room.localeCompare(b.room);

/** Returns whether a program on this machine sent the request, not through a proxy. */
const isOnThisMachine = (request: IncomingMessage): boolean =>
  clientAddressOf(request, false).isLoopback && request.headers['x-forwarded-for'] === undefined;

/**
 * Who may call a route of the relay: all pages of the server's origins, the holder of the admin token, programs on this
 * machine, or the holder of a pass to the room in the address, which the route itself verifies.
 */
type RelayAccess = 'anyone' | 'admin' | 'this-machine' | 'client';

type RelayRoute = Route<RelayAccess>;

const get = (path: string, access: RelayAccess, handle: RelayRoute['handle']): RelayRoute => ({
  method: 'GET',
  path,
  access,
  bodyLimit: 0,
  handle,
});

const post = (path: string, access: RelayAccess, handle: RelayRoute['handle']): RelayRoute => ({
  method: 'POST',
  path,
  access,
  bodyLimit: longestBody,
  handle,
});

/** Creates the HTTP service of the relay: tokens, rooms, health and metrics. */
export function createRelayService(context: RelayContext, options: RelayServiceOptions): Service<RelayAccess> {
  const { configuration, kinds, tokens, log, metrics } = context;
  const { lobby, census, endRoom, redis, roomRoutes } = options;
  const requests = roomRequests(kinds);
  const countJoin = createJoinLimit(context, redis);
  const admin = new AdminGuard(configuration, log);

  async function answerToken(call: Call): Promise<HttpResponse> {
    const request = checked(requests.token, jsonOf(call));
    const before = request.token === undefined ? null : await tokens.verifyRenewable(request.token);
    if (before && before.room === request.room && before.kind === request.kind) {
      const terms = request.terms ?? allowedTerms(kinds, before) ?? {};
      return jsonResponse({ token: await tokens.sign({ ...before, terms }) });
    }
    await countJoin(call.request);
    return jsonResponse({ token: await tokens.issue(request.room, request.kind, request.terms) });
  }

  /** Answers with the best room that has people and a free seat; otherwise with the name of a new one. */
  async function answerMatch(call: Call): Promise<HttpResponse> {
    const { kind } = checked(requests.kind, jsonOf(call));
    const { rooms } = await lobby.list();
    const [best] = rooms
      .filter((listed) => listed.kind === kind && !listed.ownTerms && listed.free > 0 && listed.players > 0)
      .sort(byPreference);
    return jsonResponse({ room: best?.room ?? newRoomName(), found: best !== undefined });
  }

  return {
    routes: [
      get('/healthz', 'anyone', () => jsonResponse({ status: 'ok', ...census() })),
      get('/metrics', 'this-machine', async () => {
        const { registry } = metrics;
        return { status: 200, headers: { 'content-type': registry.contentType }, body: await registry.metrics() };
      }),
      get(relayPath, 'anyone', () => {
        throw new HttpError(426, 'this address serves WebSockets only', { headers: { upgrade: 'websocket' } });
      }),
      get('/api/rooms', 'anyone', async () => jsonResponse(await lobby.list())),
      post('/api/rooms/match', 'anyone', answerMatch),
      post('/api/rooms/new', 'anyone', (call) => {
        checked(requests.kind, jsonOf(call));
        return jsonResponse({ room: newRoomName() });
      }),
      post('/api/rooms/end', 'admin', (call) => {
        const ended = checked(endRequest, jsonOf(call));
        endRoom(ended.room);
        return jsonResponse(ended);
      }),
      post('/api/rooms/token', 'anyone', answerToken),
      ...roomRoutes,
    ],
    async admit({ access }, { request }) {
      if (access === 'admin' && !(await admin.admits(request))) {
        throw new HttpError(403, 'this needs the admin token (THREEPOINT_ADMIN_TOKEN)');
      }
      if (access === 'this-machine' && !isOnThisMachine(request)) {
        throw new HttpError(403, 'only programs on this machine may use this address');
      }
      return undefined;
    },
    onError: (error) => log.error({ error: String(error) }, 'request failed'),
  };
}
