import { createHash, timingSafeEqual } from 'node:crypto';
import type { IncomingMessage } from 'node:http';
import type { Logger } from 'pino';
import { type AuthThrottle, createAuthThrottle } from './auth-throttle';
import { clientAddressOf } from './client-address';

const digest = (text: string): Buffer => createHash('sha256').update(text).digest();

interface AdminSettings {
  /** Nobody is admitted without one. */
  readonly adminToken: string | null;
  /** Whether a proxy in front of the server states the address of the client. */
  readonly trustProxy: boolean;
}

/** Checks the admin token, and limits how often an address may guess it. */
export class AdminGuard {
  readonly #configuration: AdminSettings;
  readonly #throttle: AuthThrottle;

  constructor(configuration: AdminSettings, log: Logger) {
    this.#configuration = configuration;
    this.#throttle = createAuthThrottle((guess) => log.warn(guess, 'wrong token of an admin'));
  }

  /** Returns whether the request has the token. Throws an HttpError 429 after too many wrong ones. */
  async admits(request: IncomingMessage): Promise<boolean> {
    const { adminToken, trustProxy } = this.#configuration;
    const secret = /^Bearer (\S{1,256})$/.exec(request.headers.authorization ?? '')?.[1];
    if (adminToken === null || secret === undefined) return false;
    const guess = { what: 'token', address: clientAddressOf(request, trustProxy), of: null, secret } as const;
    return this.#throttle.attempt(guess, () => timingSafeEqual(digest(secret), digest(adminToken)));
  }
}
