import type { IncomingMessage } from 'node:http';
import type { Redis } from 'ioredis';
import { type RateLimiterAbstract, RateLimiterMemory, RateLimiterRedis, RateLimiterRes } from 'rate-limiter-flexible';
import { clientAddressOf } from 'threepoint-http/client-address';
import { HttpError } from 'threepoint-http/http-error';
import type { RelayConfiguration } from '../settings/relay-configuration';
import type { RelayMetrics } from '../settings/relay-metrics';

export interface JoinLimitsOptions {
  readonly configuration: RelayConfiguration;
  readonly metrics: RelayMetrics;
  /** Stores the counts of all processes; null: a single process. */
  readonly redis: Redis | null;
}

const joinsPerMinuteHere = 120;

/** Limits the new people of each address per minute; the limit for this machine is higher. */
export class JoinLimits {
  readonly #options: JoinLimitsOptions;
  readonly #remote: RateLimiterAbstract;
  readonly #local: RateLimiterAbstract;

  constructor(options: JoinLimitsOptions) {
    this.#options = options;
    const { joinsPerMinute } = options.configuration;
    this.#remote = this.#limiter(joinsPerMinute, 'threepoint:joins');
    this.#local = this.#limiter(Math.max(joinsPerMinuteHere, joinsPerMinute), 'threepoint:joins-here');
  }

  /** Counts a new person from the address of this request. Throws an HttpError 429 if the limit is reached. */
  async spend(request: IncomingMessage): Promise<void> {
    const { configuration, metrics } = this.#options;
    const { network, isLoopback } = clientAddressOf(request, configuration.trustProxy);
    try {
      await (isLoopback ? this.#local : this.#remote).consume(network);
    } catch (error) {
      if (!(error instanceof RateLimiterRes)) throw error;
      metrics.refused('token', 'joins');
      const wait = Math.ceil(error.msBeforeNext / 1000);
      throw new HttpError(429, `too many new people from this address; try again in ${wait} s`, {
        headers: { 'retry-after': String(wait) },
      });
    }
  }

  #limiter(points: number, keyPrefix: string): RateLimiterAbstract {
    const alone = new RateLimiterMemory({ points, duration: 60, keyPrefix });
    const { redis: storeClient } = this.#options;
    // While Redis is unreachable, each process counts for itself.
    return storeClient
      ? new RateLimiterRedis({ storeClient, points, duration: 60, keyPrefix, insuranceLimiter: alone })
      : alone;
  }
}
