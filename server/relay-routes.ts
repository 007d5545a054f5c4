import { createHash, randomBytes, timingSafeEqual } from 'node:crypto';
import type { IncomingMessage, ServerResponse } from 'node:http';
import type { Redis } from 'ioredis';
import type { Logger } from 'pino';
import { type RateLimiterAbstract, RateLimiterMemory, RateLimiterRedis, RateLimiterRes } from 'rate-limiter-flexible';
import * as v from 'valibot';
import { roomKinds, roomTerms } from '../src/core/protocol/messages';
import { clientAddress, isLoopback } from './client-address';
import type { Lobby } from './lobby';
import type { RelayConfiguration } from './relay-configuration';
import type { RelayMetrics } from './relay-metrics';
import { type RoomTokens, roomName } from './room-tokens';
import { securityHeaders } from './security-headers';
import { originAllowed, type SocketHost } from './socket-host';

export interface RelayRoutesOptions {
  readonly configuration: RelayConfiguration;
  readonly tokens: RoomTokens;
  readonly lobby: Lobby;
  readonly host: SocketHost;
  readonly metrics: RelayMetrics;
  readonly log: Logger;
  /** Ends a room in whichever process it is. */
  readonly endRoom: (room: string) => void;
  /** Where a fleet counts who joins from where; null: this process is alone. */
  readonly redis: Redis | null;
}

const longestBody = 4096;
const joinsPerMinuteHere = 120;

const tokenRequest = v.strictObject({
  room: v.pipe(v.string(), v.regex(roomName)),
  kind: v.picklist(roomKinds),
  /** A token from before, by which the same person goes on. */
  token: v.optional(v.pipe(v.string(), v.maxLength(1024))),
  /** For a room that this person will be the first in. */
  terms: v.optional(roomTerms),
});
const endRequest = v.strictObject({ room: v.pipe(v.string(), v.regex(roomName)) });
const roomRequest = v.strictObject({ kind: v.picklist(roomKinds) });

class RequestError extends Error {
  readonly status: number;

  constructor(status: number, message: string) {
    super(message);
    this.status = status;
  }
}

async function bodyOf<Schema extends v.GenericSchema>(
  request: IncomingMessage,
  schema: Schema,
): Promise<v.InferOutput<Schema>> {
  const chunks: Buffer[] = [];
  let length = 0;
  for await (const chunk of request) {
    length += (chunk as Buffer).length;
    if (length > longestBody) throw new RequestError(413, `a body has at most ${longestBody} bytes`);
    chunks.push(chunk as Buffer);
  }
  let value: unknown;
  try {
    value = JSON.parse(Buffer.concat(chunks).toString('utf8'));
  } catch (error) {
    if (!(error instanceof SyntaxError)) throw error;
    throw new RequestError(400, 'the body is no JSON');
  }
  const result = v.safeParse(schema, value, { abortEarly: true });
  if (!result.success)
    throw new RequestError(400, `${v.getDotPath(result.issues[0]) ?? 'body'}: ${result.issues[0].message}`);
  return result.output;
}

/** A name nobody guesses: whoever knows it may come in. */
const newRoomName = (): string => randomBytes(6).toString('hex');

/**
 * The relay's part of the server's HTTP: tokens, rooms, health and metrics. Answers and returns true for requests of its own; false for
 * any other.
 */
export function createRelayRoutes(
  options: RelayRoutesOptions,
): (request: IncomingMessage, response: ServerResponse) => boolean {
  const { configuration, tokens, lobby, host, metrics, log } = options;
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
      throw new RequestError(429, `too many people from this address; try again in ${wait} s`);
    }
  }

  async function token(request: IncomingMessage): Promise<unknown> {
    const asked = await bodyOf(request, tokenRequest);
    const before = asked.token === undefined ? null : await tokens.verifyRenewable(asked.token);
    if (before && before.room === asked.room && before.kind === asked.kind) {
      return { token: await tokens.sign({ ...before, terms: asked.terms ?? before.terms }) };
    }
    await spendJoin(request);
    return { token: await tokens.issue(asked.room, asked.kind, asked.terms) };
  }

  /** A room with a seat for one more, waiting rather than playing and fuller rather than emptier; else a new one. */
  async function match(request: IncomingMessage): Promise<unknown> {
    const { kind } = await bodyOf(request, roomRequest);
    const { rooms } = await lobby.list();
    const waiting = { ready: 0, over: 1, running: 2, open: 0 } as const;
    const [best] = rooms
      .filter((room) => room.kind === kind && room.free > 0 && room.players > 0)
      .sort((a, b) => waiting[a.phase] - waiting[b.phase] || b.players - a.players || a.room.localeCompare(b.room));
    return { room: best?.room ?? newRoomName(), found: best !== undefined };
  }

  async function end(request: IncomingMessage): Promise<unknown> {
    const digest = (text: string) => createHash('sha256').update(text).digest();
    const given = /^Bearer (\S{1,256})$/.exec(request.headers.authorization ?? '')?.[1] ?? '';
    const { adminToken } = configuration;
    if (adminToken === null || !timingSafeEqual(digest(given), digest(adminToken))) {
      throw new RequestError(403, 'this needs the token of THREEPOINT_ADMIN_TOKEN');
    }
    const { room } = await bodyOf(request, endRequest);
    options.endRoom(room);
    return { room };
  }

  async function answerMetrics(request: IncomingMessage, response: ServerResponse): Promise<void> {
    // For whoever runs the server: asked for on the machine itself, not through the proxy.
    if (!isLoopback(request.socket.remoteAddress ?? '') || request.headers['x-forwarded-for'] !== undefined) {
      throw new RequestError(403, 'metrics are for this machine alone');
    }
    const text = await metrics.registry.metrics();
    response.writeHead(200, { 'content-type': metrics.registry.contentType, 'cache-control': 'no-store' });
    response.end(text);
  }

  const health = () => ({ status: 'ok', ...host.census });

  const routes: Readonly<
    Record<string, { readonly method: string; answer(request: IncomingMessage): Promise<unknown> | unknown }>
  > = {
    '/healthz': { method: 'GET', answer: health },
    '/api/rooms': {
      method: 'GET',
      answer: () => lobby.list(),
    },
    '/api/rooms/match': { method: 'POST', answer: match },
    '/api/rooms/new': {
      method: 'POST',
      answer: async (request) => {
        await bodyOf(request, roomRequest);
        return { room: newRoomName() };
      },
    },
    '/api/rooms/end': { method: 'POST', answer: end },
    '/api/rooms/token': { method: 'POST', answer: token },
  };

  function send(response: ServerResponse, status: number, json: unknown, headers: Record<string, string> = {}): void {
    response.writeHead(status, {
      'content-type': 'application/json; charset=utf-8',
      'cache-control': 'no-store',
      ...headers,
    });
    response.end(JSON.stringify(json));
  }

  async function answer(path: string, request: IncomingMessage, response: ServerResponse): Promise<void> {
    for (const [name, value] of Object.entries(securityHeaders)) response.setHeader(name, value);
    try {
      if (!originAllowed(request, configuration.origins))
        throw new RequestError(403, 'this page may not use this server');
      const route = routes[path];
      const method = route?.method ?? 'GET';
      if (request.method !== method && !(method === 'GET' && request.method === 'HEAD')) {
        send(response, 405, { error: `only ${method} is answered here` }, { allow: method });
        return;
      }
      if (!route) await answerMetrics(request, response);
      else send(response, 200, await route.answer(request));
    } catch (error) {
      if (error instanceof RequestError) {
        send(response, error.status, { error: error.message });
        return;
      }
      log.error({ error: String(error) }, 'request failed');
      send(response, 500, { error: 'the server failed' });
    }
  }

  return (request, response) => {
    const path = (request.url ?? '').replace(/[?#].*$/s, '');
    if (!Object.hasOwn(routes, path) && path !== '/metrics') return false;
    void answer(path, request, response);
    return true;
  };
}
