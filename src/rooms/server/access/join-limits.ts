import type { IncomingMessage } from 'node:http';
import type { Redis } from 'ioredis';
import { type RateLimiterAbstract, RateLimiterMemory, RateLimiterRedis, RateLimiterRes } from 'rate-limiter-flexible';
import { HttpError } from 'threepoint-http/answer';
import { clientAddressOf } from 'threepoint-http/client-address';
import type { RelayConfiguration } from '../settings/relay-configuration';
import type { RelayMetrics } from '../settings/relay-metrics';

export interface JoinLimitsOptions {
  readonly configuration: RelayConfiguration;
  readonly metrics: RelayMetrics;
  /** Holds the counts of a fleet; null: this process is alone. */
  readonly redis: Redis | null;
}

const joinsPerMinuteHere = 120;

/** Limits the new players of one address per minute; the limit of this machine itself is higher. */
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

  /** Counts one more player from the address of this request; throws an HttpError 429 where the limit is reached. */
  async spend(request: IncomingMessage): Promise<void> {
    const { configuration, metrics } = this.#options;
    const { network, isLoopback } = clientAddressOf(request, configuration.trustProxy);
    try {
      await (isLoopback ? this.#local : this.#remote).consume(network);
    } catch (error) {
      if (!(error instanceof RateLimiterRes)) throw error;
      metrics.refused('token', 'joins');
      const wait = Math.ceil(error.msBeforeNext / 1000);
      throw new HttpError(429, `too many people from this address; try again in ${wait} s`, {
        headers: { 'retry-after': String(wait) },
      });
    }
  }

  #limiter(points: number, keyPrefix: string): RateLimiterAbstract {
    const alone = new RateLimiterMemory({ points, duration: 60, keyPrefix });
    const { redis: storeClient } = this.#options;
    // Without Redis each process counts for itself.
    return storeClient
      ? new RateLimiterRedis({ storeClient, points, duration: 60, keyPrefix, insuranceLimiter: alone })
      : alone;
  }
}
