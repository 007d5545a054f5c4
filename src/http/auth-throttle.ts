import { createHash } from 'node:crypto';
import { RateLimiterMemory, RateLimiterRes } from 'rate-limiter-flexible';
import type { ClientAddress } from './client-address';
import type { HttpError } from './http-error';
import { tooManyRequests } from './rate-limit';

/** The kind of a secret: a server's token, a code that withdraws a participant's data, or an invitation to a study. */
type SecretKind = 'token' | 'withdrawal code' | 'invitation';

/** A failed attempt for the log, without the secret that was sent. */
export interface FailedAttempt {
  readonly what: SecretKind;
  readonly address: string;
  /** The study that the secret is for; null: the server itself. */
  readonly of: string | null;
  /** Wrong guesses from this address within the hour. */
  readonly failures: number;
}

export interface AuthAttempt {
  readonly what: SecretKind;
  readonly address: ClientAddress;
  readonly of: string | null;
  readonly secret: string;
}

/** Returns the refusal of an attempt that is not checked, because too many attempts before it failed. */
const tooManyAttempts = (what: SecretKind, seconds: number): HttpError =>
  tooManyRequests(`too many wrong guesses of the ${what}; try again in ${seconds} s`, seconds);

/** Limits how often secrets may be tried: the delay grows with the number of failed attempts. */
export interface AuthThrottle {
  /**
   * Calls `isRight` if this address and this study may attempt again; rejects with an HttpError 429 otherwise. If
   * `isRight` fails, no attempt is counted. A repeated wrong secret counts once. A secret that was right before is
   * never delayed.
   */
  attempt(guess: AuthAttempt, isRight: () => boolean | Promise<boolean>): Promise<boolean>;
}

/** Failures are kept for this long [s]. */
const memorySeconds = 3600;
/** A secret that was right from an address is checked without delay from there for this long [s]. */
const knownSecretSeconds = 12 * 3600;
/** Wrong guesses without a delay; after them the delay doubles from one second up to a limit [s]. */
const addressLimits = { free: 5, longestDelay: 900 } as const;
/**
 * The limits of all addresses together. The delay stays short, so that an attacker cannot lock out the study's
 * participants.
 */
const studyLimits = { free: 20, longestDelay: 60 } as const;

const digestOf = ({ what, of, secret, address: { network } }: AuthAttempt): string =>
  createHash('sha256')
    .update(JSON.stringify([what, of, secret, network]))
    .digest('base64url');

/** Counts the wrong guesses of a key and returns its delay; taking a guess and counting it are one step. */
function createDelay({ free, longestDelay }: { readonly free: number; readonly longestDelay: number }) {
  const failures = new RateLimiterMemory({ points: free, duration: memorySeconds });
  const turns = new RateLimiterMemory({ points: 1, duration: 1 });
  return {
    /** Counts a guess; resolves to null, or to the seconds to wait before it may be made. */
    async take(key: string): Promise<number | null> {
      const { consumedPoints } = await failures.penalty(key);
      if (consumedPoints <= free) return null;
      try {
        await turns.consume(key, 1, { customDuration: Math.min(longestDelay, 2 ** (consumedPoints - free - 1)) });
        return null;
      } catch (error) {
        if (!(error instanceof RateLimiterRes)) throw error;
        await failures.reward(key);
        return Math.max(1, Math.ceil(error.msBeforeNext / 1000));
      }
    },
    giveBack: (key: string) => failures.reward(key),
    forget: async (key: string) => void (await Promise.all([failures.delete(key), turns.delete(key)])),
    count: async (key: string) => (await failures.get(key))?.consumedPoints ?? 0,
  };
}

/** Creates a throttle in memory; `onWrong` is called once for each different wrong secret. */
export function createAuthThrottle(onWrong: (guess: FailedAttempt) => void): AuthThrottle {
  const byAddress = createDelay(addressLimits);
  const byStudy = createDelay(studyLimits);
  const right = new RateLimiterMemory({ points: 1, duration: knownSecretSeconds });
  const wrong = new RateLimiterMemory({ points: 1, duration: memorySeconds });

  return {
    async attempt(guess, isRight) {
      const { what, of, address } = guess;
      const { network } = address;
      const digest = digestOf(guess);
      if ((await right.get(digest)) !== null) return isRight();
      if ((await wrong.get(digest)) !== null) return false;
      const study = JSON.stringify([what, of]);
      const wait = await byAddress.take(network);
      if (wait !== null) throw tooManyAttempts(what, wait);
      const studyWait = await byStudy.take(study);
      if (studyWait !== null) {
        await byAddress.giveBack(network);
        throw tooManyAttempts(what, studyWait);
      }
      let opens: boolean;
      try {
        opens = await isRight();
      } catch (error) {
        await Promise.all([byAddress.giveBack(network), byStudy.giveBack(study)]);
        throw error;
      }
      if (opens) {
        await Promise.all([
          byAddress.forget(network),
          byStudy.giveBack(study),
          right.set(digest, 1, knownSecretSeconds),
        ]);
        return true;
      }
      await wrong.set(digest, 1, memorySeconds);
      onWrong({ what, address: address.text, of, failures: await byAddress.count(network) });
      return false;
    },
  };
}
