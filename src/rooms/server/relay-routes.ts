import { randomBytes } from 'node:crypto';
import type { IncomingMessage } from 'node:http';
import type { Redis } from 'ioredis';
import type { Logger } from 'pino';
import { checked } from 'threepoint/core/validation/validation';
import { AdminGuard } from 'threepoint-http/admin-guard';
import { type Answer, HttpError, json } from 'threepoint-http/answer';
import { clientAddressOf } from 'threepoint-http/client-address';
import { type Call, jsonOf, type Route, type Service } from 'threepoint-http/router';
import * as v from 'valibot';
import { roomTerms } from '../protocol/messages';
import { JoinLimits } from './access/join-limits';
import { assignedRoomName, type RoomTokens, roomName } from './access/room-tokens';
import type { AvatarRoutes } from './avatars/avatar-routes';
import type { RoomKinds } from './hosting/room-kinds';
import type { RoomListing } from './hosting/room-registry';
import type { Lobby } from './lobby/lobby';
import type { RelayConfiguration } from './settings/relay-configuration';
import type { RelayCensus, RelayMetrics } from './settings/relay-metrics';
import { relayPath } from './sockets/relay-transport';
import type { VoiceRoutes } from './voices/voice-routes';

export interface RelayRoutesOptions {
  readonly configuration: RelayConfiguration;
  /** The games that rooms may be for. */
  readonly kinds: RoomKinds;
  readonly tokens: RoomTokens;
  readonly lobby: Lobby;
  readonly census: () => RelayCensus;
  readonly metrics: RelayMetrics;
  readonly log: Logger;
  /** Ends a room, in this process or in another. */
  readonly endRoom: (room: string) => void;
  /** Where a fleet counts who joins from where; null: this process is alone. */
  readonly redis: Redis | null;
  readonly avatars: Pick<AvatarRoutes, 'routes'>;
  readonly voices: Pick<VoiceRoutes, 'routes'>;
}

const longestBody = 4096;

const room = v.pipe(
  v.string('expected the name of a room'),
  v.regex(roomName, 'expected small letters, digits and hyphens, at most 32, a letter or digit first'),
);
const endRequest = v.strictObject({
  room: v.union([room, v.pipe(v.string(), v.regex(assignedRoomName))], 'expected the name of a room'),
});

/** What may be asked of rooms for these games. */
function roomRequests(kinds: RoomKinds) {
  const names = [...kinds.keys()];
  const kind = v.picklist(names, `expected one of ${names.join(', ')}`);
  return {
    kind: v.strictObject({ kind }),
    token: v.strictObject({
      room,
      kind,
      /** A token from before, by which the same person goes on. */
      token: v.optional(v.pipe(v.string('expected text'), v.maxLength(1024, 'expected at most 1024 characters'))),
      /** For a room that this person will be the first in. */
      terms: v.optional(roomTerms),
    }),
  };
}

/** A name that is not guessed: to know it is to be let in. */
const newRoomName = (): string => randomBytes(6).toString('hex');

const waitingOrder = { ready: 0, over: 1, running: 2 } as const;

/** Waiting rather than playing, and fuller rather than emptier. */
const byWelcome = (a: RoomListing, b: RoomListing): number =>
  waitingOrder[a.phase] - waitingOrder[b.phase] || b.players - a.players || a.room.localeCompare(b.room);

/** Whether a program on this machine sent the request, and no proxy. */
const isOnThisMachine = (request: IncomingMessage): boolean =>
  clientAddressOf(request, false).isLoopback && request.headers['x-forwarded-for'] === undefined;

/**
 * Who may call a route of the relay: all pages of our origins, the holder of the admin's token, programs on this machine; client: the holder of a
 * pass to the room that the address names, which the route itself looks at.
 */
export type RelayAccess = 'anyone' | 'admin' | 'this-machine' | 'client';

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

/** The relay's part of the server's HTTP: tokens, rooms, health and metrics. */
export class RelayRoutes implements Service<RelayAccess> {
  readonly routes: readonly RelayRoute[];
  readonly #options: RelayRoutesOptions;
  readonly #requests: ReturnType<typeof roomRequests>;
  readonly #joins: JoinLimits;
  readonly #admin: AdminGuard;

  constructor(options: RelayRoutesOptions) {
    this.#options = options;
    this.#requests = roomRequests(options.kinds);
    this.#joins = new JoinLimits(options);
    this.#admin = new AdminGuard(options.configuration, options.log);
    this.routes = [
      get('/healthz', 'anyone', () => json({ status: 'ok', ...options.census() })),
      get('/metrics', 'this-machine', () => this.#metrics()),
      get(relayPath, 'anyone', () => {
        throw new HttpError(426, 'only WebSockets are served at this address', { headers: { upgrade: 'websocket' } });
      }),
      get('/api/rooms', 'anyone', async () => json(await options.lobby.list())),
      post('/api/rooms/match', 'anyone', (call) => this.#match(call)),
      post('/api/rooms/new', 'anyone', (call) => {
        checked(this.#requests.kind, jsonOf(call));
        return json({ room: newRoomName() });
      }),
      post('/api/rooms/end', 'admin', (call) => {
        const ended = checked(endRequest, jsonOf(call));
        options.endRoom(ended.room);
        return json(ended);
      }),
      post('/api/rooms/token', 'anyone', (call) => this.#token(call)),
      ...options.avatars.routes,
      ...options.voices.routes,
    ];
  }

  async admit({ access }: RelayRoute, { request }: { readonly request: IncomingMessage }): Promise<void> {
    if (access === 'admin' && !(await this.#admin.admits(request))) {
      throw new HttpError(403, 'this needs the token of THREEPOINT_ADMIN_TOKEN');
    }
    if (access === 'this-machine' && !isOnThisMachine(request)) {
      throw new HttpError(403, 'this is for programs on this machine alone');
    }
  }

  refusalOf(): null {
    return null;
  }

  onFault(error: unknown): void {
    this.#options.log.error({ error: String(error) }, 'request failed');
  }

  async #metrics(): Promise<Answer> {
    const { registry } = this.#options.metrics;
    return { status: 200, headers: { 'content-type': registry.contentType }, body: await registry.metrics() };
  }

  async #token(call: Call): Promise<Answer> {
    const { tokens } = this.#options;
    const asked = checked(this.#requests.token, jsonOf(call));
    const before = asked.token === undefined ? null : await tokens.verifyRenewable(asked.token);
    if (before && before.room === asked.room && before.kind === asked.kind) {
      return json({ token: await tokens.sign({ ...before, terms: asked.terms ?? before.terms }) });
    }
    await this.#joins.spend(call.request);
    return json({ token: await tokens.issue(asked.room, asked.kind, asked.terms) });
  }

  /** A room with a seat for one more, the most welcoming first; else a new one. */
  async #match(call: Call): Promise<Answer> {
    const { kind } = checked(this.#requests.kind, jsonOf(call));
    const { rooms } = await this.#options.lobby.list();
    const [best] = rooms
      .filter((listed) => listed.kind === kind && listed.free > 0 && listed.players > 0)
      .sort(byWelcome);
    return json({ room: best?.room ?? newRoomName(), found: best !== undefined });
  }
}
