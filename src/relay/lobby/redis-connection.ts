import { Redis } from 'ioredis';
import type { Logger } from 'pino';

const commandTimeoutMs = 1000;

const retryStrategy = (attempt: number): number => Math.min(200 * attempt, 2000);

/**
 * Opens a connection whose commands fail at once while Redis is down, so that no request waits; it reconnects by
 * itself.
 */
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

/** Opens a connection whose commands wait until Redis is back and never fail, as socket.io's adapter requires. */
export function connectRedisPatiently(url: string, log: Logger): Redis {
  return watched(new Redis(url, { maxRetriesPerRequest: null, retryStrategy }), log);
}

function watched(redis: Redis, log: Logger): Redis {
  let down = false;
  redis.on('error', (error: Error) => {
    if (!down)
      log.warn({ error: error.message }, 'Redis is unreachable: the lobby lists only the rooms of this process');
    down = true;
  });
  redis.on('ready', () => {
    if (down) log.warn('Redis is reachable again');
    down = false;
  });
  return redis;
}
