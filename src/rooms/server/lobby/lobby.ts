import type { Redis } from 'ioredis';
import type { Logger } from 'pino';
import type { RoomListing } from '../hosting/room-registry';

/** The list of the rooms of all processes. */
export interface Lobby {
  /** Publishes the rooms of this process. */
  publish(rooms: readonly RoomListing[]): void;
  /** Returns all rooms; if Redis is unreachable those of this process, with `complete` false. */
  list(): Promise<{ readonly rooms: readonly RoomListing[]; readonly complete: boolean }>;
  close(): Promise<void>;
}

/** Creates the lobby of a single process. */
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
/** The entry of a process expires after this time [s], so that a killed process disappears. */
const entrySeconds = 5;

/** Creates a lobby that several processes share: each stores its rooms under its own name, and the entry expires. */
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
        const entries = others.length > 0 ? await redis.mget(others.map((name) => `${prefix}node:${name}`)) : [];
        const theirs = entries.flatMap((text) => (text ? (JSON.parse(text) as RoomListing[]) : []));
        const known = new Set(own.map(({ room }) => room));
        // A room that moves between processes may be listed twice for a moment; this process's entry is current.
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
