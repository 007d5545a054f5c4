import { createHash, timingSafeEqual } from 'node:crypto';
import { RateLimiterMemory } from 'rate-limiter-flexible';
import {
  type AuthAttempt,
  type ClientAddress,
  consumePoint,
  createAuthThrottle,
  type FailedAttempt,
  requiredAddress,
  tooManyRequests,
} from 'threepoint-http';
import { Rejection } from '../../model/progress/rejection';
import { normalisedCode } from '../codes';
import type { Awaitable, StudyStorage } from '../study-storage';

/**
 * The access to a route. participant: the token of this participant or of an experimenter; invited: the invitation to
 * this place or an experimenter's token; withdrawing: a participant's withdrawal code.
 */
export type RouteAccess = 'anyone' | 'participant' | 'experimenter' | 'invited' | 'withdrawing';

export interface StudyGuardOptions {
  readonly store: Pick<StudyStorage, 'plans' | 'places'>;
  /** The experimenter's token, sent as "Authorization: Bearer …". */
  readonly experimenterToken: string;
  readonly onFailedAttempt: (guess: FailedAttempt) => void;
}

/** The sender of a request and the place in the request. */
export interface Sender {
  /** The token in the header "Authorization: Bearer …"; null: none. */
  readonly token: string | null;
  /** The client's address, by which requests are limited; null: unknown, so that limited requests are refused. */
  readonly address: ClientAddress | null;
  readonly study: string;
  readonly participant: string;
}

/**
 * The most places of an open study that one address may take within an hour. Otherwise, one person with the link could
 * take them all.
 */
export const openPlacesPerHour = 6;

const digest = (secret: string) => createHash('sha256').update(secret).digest();

/** Returns a function that counts the places of open studies for each network. A claim that throws is not counted. */
function createOpenPlaces(): <T>(network: string, claim: () => Awaitable<T>) => Promise<T> {
  const taken = new RateLimiterMemory({ points: openPlacesPerHour, duration: 3600 });

  return async (network, claim) => {
    const seconds = await consumePoint(taken, network);
    if (seconds !== null) {
      const message = `${openPlacesPerHour} places were taken from this address; try again in ${seconds} s`;
      throw tooManyRequests(message, seconds);
    }
    try {
      return await claim();
    } catch (error) {
      await taken.reward(network);
      throw error;
    }
  };
}

export type StudyGuard = ReturnType<typeof createStudyGuard>;

/** Returns the checks of tokens, invitations and withdrawal codes, which throw Rejections. */
export function createStudyGuard({ store, experimenterToken, onFailedAttempt }: StudyGuardOptions) {
  const experimenterDigest = digest(experimenterToken);
  const throttle = createAuthThrottle(onFailedAttempt);
  const spendingOpenPlace = createOpenPlaces();

  type Attempted = Omit<AuthAttempt, 'address'> & Pick<Sender, 'address'>;

  const attempt = async ({ address, ...guess }: Attempted, isRight: () => Awaitable<boolean>): Promise<boolean> =>
    throttle.attempt({ ...guess, address: requiredAddress(address) }, isRight);

  async function isExperimenter({ token, address }: Pick<Sender, 'token' | 'address'>): Promise<boolean> {
    if (token === null) return false;
    return attempt({ what: 'token', address, of: null, secret: token }, () =>
      timingSafeEqual(digest(token), experimenterDigest),
    );
  }

  const isParticipant = async ({ token, study, participant }: Sender): Promise<boolean> =>
    token !== null && store.places.holds(study, participant, token);

  return {
    isParticipant,
    /** Checks the head of a request; invitations and codes are in its body. */
    async admit(access: RouteAccess, sender: Sender): Promise<void> {
      if (access !== 'participant' && access !== 'experimenter') return;
      // Participants' tokens are 256 random bits, so they are checked regardless of failed attempts from their address.
      if (access === 'participant' && (await isParticipant(sender))) return;
      if (await isExperimenter(sender)) return;
      throw new Rejection('unauthorised', 'this needs the token of the participant or of an experimenter');
    },
    /** Runs `claim` if the invitation to the place or the token of an experimenter is right; otherwise throws. */
    async claiming<T>(sender: Sender, invitation: string | undefined, claim: () => Awaitable<T>): Promise<T> {
      const { token, address, study, participant } = sender;
      const { plan } = await store.plans.get(study);
      if (await isExperimenter({ token, address })) return claim();
      if (invitation === undefined) {
        const why = `${participant} needs an invitation, which is in the participant’s link`;
        throw new Rejection('forbidden', why, { field: 'invitation' });
      }
      const secret = `${participant} ${normalisedCode(invitation)}`;
      const right = await attempt({ what: 'invitation', address, of: study, secret }, () =>
        store.places.acceptsInvitation(study, participant, invitation),
      );
      if (!right)
        throw new Rejection('forbidden', `this is not the invitation of ${participant}`, { field: 'invitation' });
      return plan.entry === 'open' ? spendingOpenPlace(requiredAddress(address).network, claim) : claim();
    },
    /** Runs `withdraw` with a withdrawal code; throws if the code is unknown. */
    async withdrawing<T>({ address, study }: Sender, code: string, withdraw: () => Awaitable<T | null>): Promise<T> {
      await store.plans.get(study);
      let result: T | null = null;
      const secret = normalisedCode(code);
      await attempt({ what: 'withdrawal code', address, of: study, secret }, async () => {
        result = await withdraw();
        return result !== null;
      });
      if (result === null) throw new Rejection('unknown', 'nothing is recorded under this code');
      return result;
    },
  };
}
