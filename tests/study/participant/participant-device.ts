import 'fake-indexeddb/auto';
import { expect, vi } from 'vitest';
import { createParticipantClient } from '../../../src/study/client/study-client';
import { ParticipantSession, startSession } from '../../../src/study/participant/session/participant-session';
import { openStudyVault, type StudyVault } from '../../../src/study/participant/session/study-vault';
import { aWomanOf26, outcomeOf, paperPlan } from '../model/studies';
import { place } from './study-server';

const plan = paperPlan();

/** The measures of the participant. */
export const calibration = { eyeHeight: 1.62, armSpan: 1.4 };

/** A device of P01 with a separate vault and a clock that advances with every reading. */
export async function device(
  { origin, invitation }: { readonly origin: string; readonly invitation: string },
  { clock = 1e9 }: { readonly clock?: number } = {},
) {
  const name = `vault ${crypto.randomUUID()}`;
  let now = clock;
  const client = createParticipantClient(origin);
  const options = (vault: StudyVault | null) => ({
    client,
    vault,
    now: () => {
      now += 1;
      return now;
    },
    onChange: () => undefined,
  });
  const vault = await openStudyVault(name);
  const claim = await client.claim(place, invitation, plan.consent.version);
  const first = new ParticipantSession(startSession(claim, place), { records: [], motion: [] }, options(vault));
  return {
    first,
    claim,
    options,
    vault,
    /** Loads the page again: only the vault is left. */
    async reload(): Promise<ParticipantSession> {
      const again = await openStudyVault(name);
      const kept = await again.session(place);
      if (!kept) throw new Error('the vault holds no session');
      const left = { records: await again.records(place), motion: await again.motion(place) };
      const session = new ParticipantSession(kept, left, options(again));
      session.apply({ type: 'reload' });
      return session;
    },
  };
}

/** The participant has played the first round and rests; `motion`: with consent to tracked frames. */
export function toTheFirstRest(session: ParticipantSession, motion = false): void {
  const said = [
    session.apply({ type: 'consent', motion, version: plan.consent.version }),
    session.apply({ type: 'demographics', demographics: aWomanOf26 }),
    session.apply({ type: 'calibrated', calibration }),
    session.apply({ type: 'start' }),
    session.apply({ type: 'trial-finished', outcome: outcomeOf(10) }),
    session.apply({ type: 'start' }),
    session.apply({ type: 'trial-finished', outcome: outcomeOf(40) }),
  ];
  expect(said).toEqual(said.map(() => null));
  expect(session.step.kind).toBe('rest');
}

/**
 * The participant has played the first round, rested, and sits before its questions; `motion`: with consent to tracked
 * frames.
 */
export function toTheFirstQuestion(session: ParticipantSession, motion = false): void {
  toTheFirstRest(session, motion);
  // A rest is over when enough ticks of this clock have passed.
  for (let i = 0; i < 200 && session.step.kind === 'rest'; i++) session.apply({ type: 'tick' });
  expect(session.step.kind).toBe('questionnaire');
}

/** Makes every write to the device fail as a full disk does; returns a function that makes room again. */
export function fillDevice(): () => void {
  const put = vi.spyOn(IDBObjectStore.prototype, 'put').mockImplementation(() => {
    throw new DOMException('the quota is used up', 'QuotaExceededError');
  });
  return () => put.mockRestore();
}
