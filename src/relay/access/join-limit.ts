import type { IncomingMessage } from 'node:http';
import type { Redis } from 'ioredis';
import { type RateLimiterAbstract, RateLimiterMemory, RateLimiterRedis } from 'rate-limiter-flexible';
import { clientAddressOf, consumePoint, tooManyRequests } from 'threepoint-http';
import type { RelayContext } from '../relay-context';

const joinsPerMinuteHere = 120;

/** Creates the limiter of new people per minute. `redis` stores the counts of all processes; null: a single process. */
function createLimiter(points: number, keyPrefix: string, redis: Redis | null): RateLimiterAbstract {
  const alone = new RateLimiterMemory({ points, duration: 60, keyPrefix });
  // While Redis is unreachable, each process counts for itself.
  return redis
    ? new RateLimiterRedis({ storeClient: redis, points, duration: 60, keyPrefix, insuranceLimiter: alone })
    : alone;
}

/**
 * Returns a function that counts a new person from the address of a request, and throws an HttpError 429 if the limit
 * of that address is reached. The limit for this machine is higher.
 */
export function createJoinLimit(
  { configuration: { joinsPerMinute, trustProxy }, metrics }: Pick<RelayContext, 'configuration' | 'metrics'>,
  redis: Redis | null,
): (request: IncomingMessage) => Promise<void> {
  const remote = createLimiter(joinsPerMinute, 'threepoint:joins', redis);
  const local = createLimiter(Math.max(joinsPerMinuteHere, joinsPerMinute), 'threepoint:joins-here', redis);
  return async (request) => {
    const { network, isLoopback } = clientAddressOf(request, trustProxy);
    const wait = await consumePoint(isLoopback ? local : remote, network);
    if (wait === null) return;
    metrics.refused('token', 'joins');
    throw tooManyRequests(`too many new people from this address; try again in ${wait} s`, wait);
  };
}
