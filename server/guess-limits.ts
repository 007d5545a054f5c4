import { createHash } from 'node:crypto';
import { RateLimiterMemory, RateLimiterRes } from 'rate-limiter-flexible';
import { networkOf } from './client-address';

/** What a guess is of: a token that opens a server, a code that deletes, an invitation that takes a place. */
export type Guessed = 'token' | 'withdrawal code' | 'invitation';

/** A wrong guess as the log may have it: everything but the guess. */
export interface WrongGuess {
  readonly what: Guessed;
  readonly address: string;
  /** The study; null: the server itself. */
  readonly of: string | null;
  /** Wrong ones of this address within the hour. */
  readonly failures: number;
}

export interface Guess {
  readonly what: Guessed;
  readonly address: string;
  readonly of: string | null;
  /** What was sent, with what it is to open. */
  readonly secret: string;
}

/** So many wrong guesses came already that this one was not even looked at. */
export class TooManyGuesses extends Error {
  readonly retryAfterSeconds: number;

  constructor(what: Guessed, retryAfterSeconds: number) {
    super(`too many wrong guesses of a ${what}; try again in ${retryAfterSeconds} s`);
    this.retryAfterSeconds = retryAfterSeconds;
  }
}

/** Lets secrets be tried, and ever more slowly the more of them were wrong. */
export interface GuessLimits {
  /**
   * Asks `isRight` where another guess may be made from this address and at this study; throws TooManyGuesses where it may not.
   * `isRight` answers at once; where it throws, nothing was guessed. A wrong secret that is repeated is one guess; one that was right before
   * waits for no one.
   */
  attempt(guess: Guess, isRight: () => boolean): Promise<boolean>;
}

/** Failures are remembered for this long [s]. */
const memorySeconds = 3600;
/** A secret that opened something from an address goes on being looked at from there for so long [s]. */
const trustSeconds = 12 * 3600;
/** Wrong guesses without delay, then the delay doubles from a second up to a limit [s]. */
const addressLimits = { free: 5, longestDelay: 900 } as const;
/** Of all addresses together; its delay stays short, or a stranger could keep the study's own people out. */
const studyLimits = { free: 20, longestDelay: 60 } as const;

const digestOf = ({ what, of, secret, address }: Guess): string =>
  createHash('sha256')
    .update(JSON.stringify([what, of, secret, address]))
    .digest('base64url');

/** Counts the wrong guesses of a key and says how long it has to wait; taking a guess and counting it are one step. */
function createDelay({ free, longestDelay }: { readonly free: number; readonly longestDelay: number }) {
  const failures = new RateLimiterMemory({ points: free, duration: memorySeconds });
  const turns = new RateLimiterMemory({ points: 1, duration: 1 });
  return {
    /** Counts one; a number: it may not be made for so many seconds. */
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

export function createGuessLimits(onWrong: (guess: WrongGuess) => void): GuessLimits {
  const byAddress = createDelay(addressLimits);
  const byStudy = createDelay(studyLimits);
  const right = new RateLimiterMemory({ points: 1, duration: trustSeconds });
  const wrong = new RateLimiterMemory({ points: 1, duration: memorySeconds });

  return {
    async attempt(guess, isRight) {
      const { what, of } = guess;
      const address = networkOf(guess.address);
      const digest = digestOf({ ...guess, address });
      if ((await right.get(digest)) !== null) return isRight();
      if ((await wrong.get(digest)) !== null) return false;
      const study = JSON.stringify([what, of]);
      const wait = await byAddress.take(address);
      if (wait !== null) throw new TooManyGuesses(what, wait);
      const studyWait = await byStudy.take(study);
      if (studyWait !== null) {
        await byAddress.giveBack(address);
        throw new TooManyGuesses(what, studyWait);
      }
      let opens: boolean;
      try {
        opens = isRight();
      } catch (error) {
        await Promise.all([byAddress.giveBack(address), byStudy.giveBack(study)]);
        throw error;
      }
      if (opens) {
        await Promise.all([byAddress.forget(address), byStudy.giveBack(study), right.set(digest, 1, trustSeconds)]);
        return true;
      }
      await wrong.set(digest, 1, memorySeconds);
      onWrong({ what, address: guess.address, of, failures: await byAddress.count(address) });
      return false;
    },
  };
}
