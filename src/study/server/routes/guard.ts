import { createHash, timingSafeEqual } from 'node:crypto';
import { RateLimiterMemory, RateLimiterRes } from 'rate-limiter-flexible';
import { HttpError } from 'threepoint-http/answer';
import { createAuthThrottle, type Guess, TooManyGuesses, type WrongGuess } from 'threepoint-http/auth-throttle';
import { type ClientAddress, requiredAddress } from 'threepoint-http/client-address';
import { normalisedCode } from '../storage/schema';
import type { StudyStore } from '../storage/store';

/**
 * Who may call a route of the studies. participant: with the token of this very participant, or as an experimenter; invited: with the
 * invitation to this place, or as an experimenter; withdrawing: with a participant's withdrawal code.
 */
export type StudyAccess = 'anyone' | 'participant' | 'experimenter' | 'invited' | 'withdrawing';

export interface StudyGuardOptions {
  readonly store: StudyStore;
  /** The holder of this, sent as "Authorization: Bearer …", is an experimenter; null: no one is. */
  readonly experimenterToken: string | null;
  readonly onWrongGuess: (guess: WrongGuess) => void;
}

/** Who sends a request, and the place that it concerns. */
export interface Concerned {
  /** What its header Authorization has as "Bearer …"; null: nothing. */
  readonly token: string | null;
  /** The client's address, which limits count; null: it is not known, and a limit refuses the request. */
  readonly address: ClientAddress | null;
  readonly study: string;
  readonly participant: string;
}

/** Makes sure of secrets: of tokens, invitations and withdrawal codes. What it throws are HttpErrors. */
export interface StudyGuard {
  /** Whether the request bears this participant's own token. */
  isParticipant(concerned: Concerned): boolean;
  /** What can be told from a request's head; invitations and codes come with its body. */
  admit(access: StudyAccess, concerned: Concerned): Promise<void>;
  /** Runs what the invitation to the place opens, or an experimenter; throws where this is neither. */
  claiming<T>(concerned: Concerned, invitation: string | undefined, claim: () => T): Promise<T>;
  /** Runs what a withdrawal code opens; throws where it opens nothing. */
  withdrawing<T>(concerned: Omit<Concerned, 'participant'>, code: string, withdraw: () => T | null): Promise<T>;
}

/** Places of an open study that one address may take within an hour: a person who has the study's link could take them all otherwise. */
export const openPlacesPerHour = 6;

const digest = (secret: string) => createHash('sha256').update(secret).digest();

const tooMany = (message: string, seconds: number) =>
  new HttpError(429, message, { headers: { 'retry-after': String(seconds) } });

/** Counts the places of open studies that each network takes: runs what takes one, and gives it back to the network where that throws. */
function createOpenPlaces(): <T>(network: string, claim: () => T) => Promise<T> {
  const taken = new RateLimiterMemory({ points: openPlacesPerHour, duration: 3600 });

  async function spend(network: string): Promise<void> {
    try {
      await taken.consume(network);
    } catch (error) {
      if (!(error instanceof RateLimiterRes)) throw error;
      const seconds = Math.ceil(error.msBeforeNext / 1000);
      throw tooMany(`${openPlacesPerHour} places were taken from this address; try again in ${seconds} s`, seconds);
    }
  }

  return async (network, claim) => {
    await spend(network);
    try {
      return claim();
    } catch (error) {
      await taken.reward(network);
      throw error;
    }
  };
}

export function createStudyGuard(options: StudyGuardOptions): StudyGuard {
  const { store, experimenterToken, onWrongGuess } = options;
  const experimenterDigest = experimenterToken === null ? null : digest(experimenterToken);
  const throttle = createAuthThrottle(onWrongGuess);
  const spendingOpenPlace = createOpenPlaces();

  type Attempted = Omit<Guess, 'address'> & Pick<Concerned, 'address'>;

  async function attempt({ address, ...guess }: Attempted, isRight: () => boolean): Promise<boolean> {
    try {
      return await throttle.attempt({ ...guess, address: requiredAddress(address) }, isRight);
    } catch (error) {
      if (!(error instanceof TooManyGuesses)) throw error;
      throw tooMany(error.message, error.retryAfterSeconds);
    }
  }

  async function isExperimenter({ token, address }: Pick<Concerned, 'token' | 'address'>): Promise<boolean> {
    if (token === null) return false;
    return attempt(
      { what: 'token', address, of: null, secret: token },
      () => experimenterDigest !== null && timingSafeEqual(digest(token), experimenterDigest),
    );
  }

  const isParticipant = ({ token, study, participant }: Concerned) =>
    token !== null && store.places.holds(study, participant, token);

  return {
    isParticipant,
    async admit(access, concerned) {
      if (access !== 'participant' && access !== 'experimenter') return;
      // Participants' tokens are 256 drawn bits: they are looked at however many guesses came from their address.
      if (access === 'participant' && isParticipant(concerned)) return;
      if (await isExperimenter(concerned)) return;
      throw new HttpError(401, 'this needs the token of the participant or of an experimenter');
    },
    async claiming({ token, address, study, participant }, invitation, claim) {
      const { plan } = store.plans.get(study);
      if (await isExperimenter({ token, address })) return claim();
      if (invitation === undefined) {
        const why = `${participant} is taken by invitation: it stands in the link of the participant`;
        throw new HttpError(403, why, { field: 'invitation' });
      }
      const secret = `${participant} ${normalisedCode(invitation)}`;
      const right = await attempt({ what: 'invitation', address, of: study, secret }, () =>
        store.places.invites(study, participant, invitation),
      );
      if (!right) throw new HttpError(403, `this is not the invitation of ${participant}`, { field: 'invitation' });
      return plan.entry === 'open' ? spendingOpenPlace(requiredAddress(address).network, claim) : claim();
    },
    async withdrawing({ address, study }, code, withdraw) {
      store.plans.get(study);
      let result: ReturnType<typeof withdraw> = null;
      const secret = normalisedCode(code);
      await attempt({ what: 'withdrawal code', address, of: study, secret }, () => {
        result = withdraw();
        return result !== null;
      });
      if (result === null) throw new HttpError(404, 'nothing is recorded under this code');
      return result;
    },
  };
}
