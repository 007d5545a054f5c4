import { type RateLimiterAbstract, RateLimiterRes } from 'rate-limiter-flexible';
import { HttpError } from './http-error';

/** Takes a point of a key. Resolves to null; where none is left, to the time until there is one [s], an integer. */
export async function consumePoint(limiter: RateLimiterAbstract, key: string): Promise<number | null> {
  try {
    await limiter.consume(key);
    return null;
  } catch (error) {
    if (!(error instanceof RateLimiterRes)) throw error;
    return Math.ceil(error.msBeforeNext / 1000);
  }
}

/** Returns the refusal of a client that may try again after so many seconds. */
export const tooManyRequests = (message: string, seconds: number): HttpError =>
  new HttpError(429, message, { headers: { 'retry-after': String(seconds) } });
