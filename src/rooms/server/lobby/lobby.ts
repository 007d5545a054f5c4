import { Redis } from 'ioredis';
import type { Logger } from 'pino';
import type { RoomListing } from '../hosting/room-registry';

/** Rooms of all processes, as far as this one knows. */
export interface Lobby {
  /** What this process has now. */
  publish(rooms: readonly RoomListing[]): void;
  /** Everything; where the common store cannot be reached: what this process has, and `complete` false. */
  list(): Promise<{ readonly rooms: readonly RoomListing[]; readonly complete: boolean }>;
  close(): Promise<void>;
}

/** The lobby of a process that is alone. */
export function createOwnLobby(): Lobby {
  let own: readonly RoomListing[] = [];
  return {
    publish(rooms) {
      own = rooms;
    },
    list: async () => ({ rooms: own, complete: true }),
    close: async () => undefined,
  };
}

const prefix = 'threepoint:lobby:';
/** What a process has said is believed this long [s]: one that was killed is forgotten then. */
const entrySeconds = 5;
const commandTimeoutMs = 1000;

const retryStrategy = (attempt: number): number => Math.min(200 * attempt, 2000);

/** A connection whose commands fail at once without Redis, so that no request waits for them; it comes back by itself. */
export function connectRedis(url: string, log: Logger): Redis {
  return watched(
    new Redis(url, {
      enableOfflineQueue: false,
      maxRetriesPerRequest: 1,
      commandTimeout: commandTimeoutMs,
      retryStrategy,
    }),
    log,
  );
}

/** A connection whose commands wait for Redis however long that takes, and never fail: what socket.io's adapter expects. */
export function connectRedisPatiently(url: string, log: Logger): Redis {
  return watched(new Redis(url, { maxRetriesPerRequest: null, retryStrategy }), log);
}

function watched(redis: Redis, log: Logger): Redis {
  let down = false;
  redis.on('error', (error: Error) => {
    if (!down)
      log.warn({ error: error.message }, 'Redis cannot be reached: the lobby shows the rooms of this process alone');
    down = true;
  });
  redis.on('ready', () => {
    if (down) log.warn('Redis is back');
    down = false;
  });
  return redis;
}

/** The lobby of a fleet: every process tells its rooms under its own name, and what it told expires. */
export function createRedisLobby(redis: Redis, node: string, log: Logger): Lobby {
  let own: readonly RoomListing[] = [];
  const failed = (error: unknown): void => log.debug({ error: String(error) }, 'lobby not stored');
  return {
    publish(rooms) {
      own = rooms;
      const now = Date.now();
      redis
        .multi()
        .set(`${prefix}node:${node}`, JSON.stringify(rooms), 'EX', entrySeconds)
        .zadd(`${prefix}nodes`, now, node)
        .zremrangebyscore(`${prefix}nodes`, 0, now - 60_000)
        .exec()
        .catch(failed);
    },
    async list() {
      try {
        const nodes = await redis.zrange(`${prefix}nodes`, 0, -1);
        const others = nodes.filter((name) => name !== node);
        const told = others.length > 0 ? await redis.mget(others.map((name) => `${prefix}node:${name}`)) : [];
        const theirs = told.flatMap((text) => (text ? (JSON.parse(text) as RoomListing[]) : []));
        const known = new Set(own.map(({ room }) => room));
        // After a move between processes a room may be told twice for a moment: ours is the living one.
        return { rooms: [...own, ...theirs.filter(({ room }) => !known.has(room))], complete: true };
      } catch (error) {
        failed(error);
        return { rooms: own, complete: false };
      }
    },
    async close() {
      redis.disconnect();
    },
  };
}
