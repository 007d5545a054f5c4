import { createHash, randomBytes, timingSafeEqual } from 'node:crypto';
import type { IncomingMessage } from 'node:http';
import type { Redis } from 'ioredis';
import type { Logger } from 'pino';
import { type RateLimiterAbstract, RateLimiterMemory, RateLimiterRedis, RateLimiterRes } from 'rate-limiter-flexible';
import * as v from 'valibot';
import { roomKinds, roomTerms } from '../src/core/protocol/messages';
import { checked } from '../src/core/study/validation';
import { clientAddress, isLoopback } from './client-address';
import { createGuessLimits, TooManyGuesses } from './guess-limits';
import { type Answer, HttpError, json } from './http/answer';
import { type Call, jsonOf, type Route, type Service } from './http/router';
import type { Lobby } from './lobby';
import type { RelayConfiguration } from './relay-configuration';
import type { RelayCensus, RelayMetrics } from './relay-metrics';
import { relayPath } from './relay-transport';
import { assignedRoomName, type RoomTokens, roomName } from './room-tokens';

export interface RelayRoutesOptions {
  readonly configuration: RelayConfiguration;
  readonly tokens: RoomTokens;
  readonly lobby: Lobby;
  readonly census: () => RelayCensus;
  readonly metrics: RelayMetrics;
  readonly log: Logger;
  /** Ends a room in whichever process it is. */
  readonly endRoom: (room: string) => void;
  /** Where a fleet counts who joins from where; null: this process is alone. */
  readonly redis: Redis | null;
}

const longestBody = 4096;
const joinsPerMinuteHere = 120;

const room = v.pipe(
  v.string('expected the name of a room'),
  v.regex(roomName, 'expected small letters, digits and hyphens, at most 32, a letter or digit first'),
);
const kind = v.picklist(roomKinds, `expected one of ${roomKinds.join(', ')}`);
const tokenRequest = v.strictObject({
  room,
  kind,
  /** A token from before, by which the same person goes on. */
  token: v.optional(v.pipe(v.string('expected text'), v.maxLength(1024, 'expected at most 1024 characters'))),
  /** For a room that this person will be the first in. */
  terms: v.optional(roomTerms),
});
const endRequest = v.strictObject({
  room: v.union([room, v.pipe(v.string(), v.regex(assignedRoomName))], 'expected the name of a room'),
});
const roomRequest = v.strictObject({ kind });

/** A name that is not guessed: to know it is to be let in. */
const newRoomName = (): string => randomBytes(6).toString('hex');

/** Who may call a route of the relay: all pages of our origins, the holder of the admin's token, programs on this machine. */
export type RelayAccess = 'anyone' | 'admin' | 'this-machine';

/** The relay's part of the server's HTTP: tokens, rooms, health and metrics. */
export function createRelayRoutes(options: RelayRoutesOptions): Service<RelayAccess> {
  const { configuration, tokens, lobby, metrics, log } = options;
  const limiter = (points: number, keyPrefix: string): RateLimiterAbstract => {
    const alone = new RateLimiterMemory({ points, duration: 60, keyPrefix });
    const { redis: storeClient } = options;
    // Without Redis each process counts for itself.
    return storeClient
      ? new RateLimiterRedis({ storeClient, points, duration: 60, keyPrefix, insuranceLimiter: alone })
      : alone;
  };
  const joins = limiter(configuration.joinsPerMinute, 'threepoint:joins');
  const joinsHere = limiter(Math.max(joinsPerMinuteHere, configuration.joinsPerMinute), 'threepoint:joins-here');

  async function spendJoin(request: IncomingMessage): Promise<void> {
    const address = clientAddress(request, configuration.trustProxy);
    try {
      await (isLoopback(address) ? joinsHere : joins).consume(address);
    } catch (error) {
      if (!(error instanceof RateLimiterRes)) throw error;
      metrics.refused('token', 'joins');
      const wait = Math.ceil(error.msBeforeNext / 1000);
      throw new HttpError(429, `too many people from this address; try again in ${wait} s`, {
        headers: { 'retry-after': String(wait) },
      });
    }
  }

  async function token(call: Call): Promise<Answer> {
    const asked = checked(tokenRequest, jsonOf(call));
    const before = asked.token === undefined ? null : await tokens.verifyRenewable(asked.token);
    if (before && before.room === asked.room && before.kind === asked.kind) {
      return json({ token: await tokens.sign({ ...before, terms: asked.terms ?? before.terms }) });
    }
    await spendJoin(call.request);
    return json({ token: await tokens.issue(asked.room, asked.kind, asked.terms) });
  }

  /** A room with a seat for one more, waiting rather than playing and fuller rather than emptier; else a new one. */
  async function match(call: Call): Promise<Answer> {
    const { kind } = checked(roomRequest, jsonOf(call));
    const { rooms } = await lobby.list();
    const waiting = { ready: 0, over: 1, running: 2, open: 0 } as const;
    const [best] = rooms
      .filter((room) => room.kind === kind && room.free > 0 && room.players > 0)
      .sort((a, b) => waiting[a.phase] - waiting[b.phase] || b.players - a.players || a.room.localeCompare(b.room));
    return json({ room: best?.room ?? newRoomName(), found: best !== undefined });
  }

  const guesses = createGuessLimits((guess) => log.warn(guess, 'wrong token of an admin'));

  async function isAdmin(request: IncomingMessage): Promise<boolean> {
    const digest = (text: string) => createHash('sha256').update(text).digest();
    const secret = /^Bearer (\S{1,256})$/.exec(request.headers.authorization ?? '')?.[1];
    const { adminToken } = configuration;
    if (adminToken === null || secret === undefined) return false;
    const guess = {
      what: 'token',
      address: clientAddress(request, configuration.trustProxy),
      of: null,
      secret,
    } as const;
    try {
      return await guesses.attempt(guess, () => timingSafeEqual(digest(secret), digest(adminToken)));
    } catch (error) {
      if (!(error instanceof TooManyGuesses)) throw error;
      throw new HttpError(429, error.message, { headers: { 'retry-after': String(error.retryAfterSeconds) } });
    }
  }

  /** Asked for on the machine itself, not through a proxy. */
  const isOnThisMachine = ({ headers, socket }: IncomingMessage): boolean =>
    isLoopback(socket.remoteAddress ?? '') && headers['x-forwarded-for'] === undefined;

  const routes: readonly Route<RelayAccess>[] = [
    {
      method: 'GET',
      path: '/healthz',
      access: 'anyone',
      bodyLimit: 0,
      handle: () => json({ status: 'ok', ...options.census() }),
    },
    {
      method: 'GET',
      path: '/metrics',
      access: 'this-machine',
      bodyLimit: 0,
      handle: async () => ({
        status: 200,
        headers: { 'content-type': metrics.registry.contentType },
        body: await metrics.registry.metrics(),
      }),
    },
    {
      method: 'GET',
      path: relayPath,
      access: 'anyone',
      bodyLimit: 0,
      handle: () => {
        throw new HttpError(426, 'only WebSockets are served at this address', { headers: { upgrade: 'websocket' } });
      },
    },
    {
      method: 'GET',
      path: '/api/rooms',
      access: 'anyone',
      bodyLimit: 0,
      handle: async () => json(await lobby.list()),
    },
    { method: 'POST', path: '/api/rooms/match', access: 'anyone', bodyLimit: longestBody, handle: match },
    {
      method: 'POST',
      path: '/api/rooms/new',
      access: 'anyone',
      bodyLimit: longestBody,
      handle: (call) => {
        checked(roomRequest, jsonOf(call));
        return json({ room: newRoomName() });
      },
    },
    {
      method: 'POST',
      path: '/api/rooms/end',
      access: 'admin',
      bodyLimit: longestBody,
      handle: (call) => {
        const { room } = checked(endRequest, jsonOf(call));
        options.endRoom(room);
        return json({ room });
      },
    },
    { method: 'POST', path: '/api/rooms/token', access: 'anyone', bodyLimit: longestBody, handle: token },
  ];

  return {
    routes,
    async admit({ access }, { request }) {
      if (access === 'admin' && !(await isAdmin(request))) {
        throw new HttpError(403, 'this needs the token of THREEPOINT_ADMIN_TOKEN');
      }
      if (access === 'this-machine' && !isOnThisMachine(request)) {
        throw new HttpError(403, 'this is for programs on this machine alone');
      }
    },
    refusalOf: () => null,
    onFault: (error) => log.error({ error: String(error) }, 'request failed'),
  };
}
