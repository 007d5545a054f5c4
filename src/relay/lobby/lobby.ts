import type { Redis } from 'ioredis';
import type { Logger } from 'pino';
import type { RoomListing } from '../hosting/room-registry';

const prefix = 'threepoint:lobby:';
/** The entry of a process expires after this time [s], so that a killed process disappears. */
const entrySeconds = 5;

export type Lobby = ReturnType<typeof createLobby>;

/**
 * Creates the list of the rooms of all processes. Each process stores its rooms in Redis under its own name, and the
 * entry expires. `redis` null: a single process.
 */
export function createLobby(redis: Redis | null, node: string, log: Logger) {
  let own: readonly RoomListing[] = [];
  const failed = (error: unknown): void => log.debug({ error: String(error) }, 'lobby not stored');

  async function listOthers(store: Redis): Promise<RoomListing[]> {
    const nodes = await store.zrange(`${prefix}nodes`, 0, -1);
    const others = nodes.filter((name) => name !== node);
    const entries = others.length > 0 ? await store.mget(others.map((name) => `${prefix}node:${name}`)) : [];
    return entries.flatMap((text) => (text ? (JSON.parse(text) as RoomListing[]) : []));
  }

  return {
    publish(rooms: readonly RoomListing[]): void {
      own = rooms;
      const now = Date.now();
      redis
        ?.multi()
        .set(`${prefix}node:${node}`, JSON.stringify(rooms), 'EX', entrySeconds)
        .zadd(`${prefix}nodes`, now, node)
        .zremrangebyscore(`${prefix}nodes`, 0, now - 60_000)
        .exec()
        .catch(failed);
    },
    /** Returns all rooms; if Redis is unreachable those of this process, with `complete` false. */
    async list(): Promise<{ readonly rooms: readonly RoomListing[]; readonly complete: boolean }> {
      try {
        const theirs = redis ? await listOthers(redis) : [];
        const known = new Set(own.map(({ room }) => room));
        // A room that moves between processes may be listed twice for a moment; this process's entry is current.
        return { rooms: [...own, ...theirs.filter(({ room }) => !known.has(room))], complete: true };
      } catch (error) {
        failed(error);
        return { rooms: own, complete: false };
      }
    },
  };
}
