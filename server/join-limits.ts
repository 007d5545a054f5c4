import type { IncomingMessage } from 'node:http';
import type { Redis } from 'ioredis';
import { type RateLimiterAbstract, RateLimiterMemory, RateLimiterRedis, RateLimiterRes } from 'rate-limiter-flexible';
import { clientAddress, isLoopback } from './client-address';
import { HttpError } from './http/answer';
import type { RelayConfiguration } from './relay-configuration';
import type { RelayMetrics } from './relay-metrics';

export interface JoinLimitsOptions {
  readonly configuration: RelayConfiguration;
  readonly metrics: RelayMetrics;
  /** Where a fleet counts; null: this process is alone. */
  readonly redis: Redis | null;
}

const joinsPerMinuteHere = 120;

/** How many new people may come from one address a minute; more from this machine itself. */
export class JoinLimits {
  readonly #options: JoinLimitsOptions;
  readonly #elsewhere: RateLimiterAbstract;
  readonly #here: RateLimiterAbstract;

  constructor(options: JoinLimitsOptions) {
    this.#options = options;
    const { joinsPerMinute } = options.configuration;
    this.#elsewhere = this.#limiter(joinsPerMinute, 'threepoint:joins');
    this.#here = this.#limiter(Math.max(joinsPerMinuteHere, joinsPerMinute), 'threepoint:joins-here');
  }

  /** Counts one more person from the address of this request; throws the answer 429 where there have been too many. */
  async spend(request: IncomingMessage): Promise<void> {
    const { configuration, metrics } = this.#options;
    const address = clientAddress(request, configuration.trustProxy);
    try {
      await (isLoopback(address) ? this.#here : this.#elsewhere).consume(address);
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
