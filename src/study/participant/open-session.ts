import { type ParticipantClient, ServerUnreachable, type StudyPlace } from '../client/study-client';
import { PhrasedError } from '../model/phrases/phrases';
import { scheduleFor } from '../model/plan/schedule';
import { isLater, type Progress } from '../model/progress/progress';
import { Rejection } from '../model/progress/rejection';
import type { PublicStudy } from '../model/progress/study-api';
import type { ConsentChoices } from './forms/study-form';
import { ParticipantSession, type ParticipantSessionOptions, startSession } from './session/participant-session';
import type { Unsent } from './session/session-store';
import { type KeptSession, openStudyVault, type StudyVault } from './session/study-vault';

/** A session that this device has stored is resumed; otherwise consent is asked for first. */
export type OpenedSession =
  | { readonly kind: 'resumed'; readonly session: ParticipantSession }
  | {
      readonly kind: 'new';
      readonly study: PublicStudy;
      /**
       * Takes the place and begins. Resolves with `uninvited` if the invitation is wrong, with `changed` if the text
       * has changed since it was read, and with `why` after another error.
       */
      agree(
        choices: ConsentChoices,
        invitation: string,
      ): Promise<ParticipantSession | 'uninvited' | 'changed' | { readonly why: unknown }>;
    };

/**
 * Returns a session that another device began with the language chosen here, and without motion unless consent to it is
 * given again. A new consent to motion has no effect, because the recorded consent is without it.
 */
function withChoices(session: KeptSession, { motion, language }: ConsentChoices): KeptSession {
  const { progress } = session;
  const keptMotion = progress.motion && motion;
  return { ...session, progress: { ...progress, motion: keptMotion, ...(language !== null && { language }) } };
}

const noMotionHere = 'On another device the participant did not agree to have motion kept: from here on none is.';

export interface OpeningOptions extends Omit<ParticipantSessionOptions, 'vault'> {
  /** The time limit of requests to the storage [ms]; undefined: the default. */
  readonly storageLimitMs?: number | undefined;
}

interface OnDevice {
  /** null: this browser stores nothing. */
  readonly vault: StudyVault | null;
  /** A session of an earlier visit, with what it has not sent. */
  readonly kept: (Unsent & { readonly session: KeptSession }) | null;
}

async function readDevice(place: StudyPlace, storageLimitMs?: number): Promise<OnDevice> {
  try {
    const vault = await openStudyVault(undefined, storageLimitMs);
    const session = await vault.session(place);
    if (!session) return { vault, kept: null };
    const [records, motion] = await Promise.all([vault.records(place), vault.motion(place)]);
    return { vault, kept: { session, records, motion } };
  } catch {
    // reason: a browser without storage is a state of the session (uploadStatus.storageFault), shown on every screen
    return { vault: null, kept: null };
  }
}

/**
 * Resolves with whether this is the only page of the participant: two pages would send two sessions to the server. A
 * browser without storage refuses the lock too, and its pages share no session.
 */
function lockParticipant({ study, participant }: StudyPlace): Promise<boolean> {
  if (!navigator.locks) return Promise.resolve(true);
  return new Promise((resolve, reject) => {
    const held = navigator.locks.request(`threepoint study ${study} ${participant}`, { ifAvailable: true }, (lock) => {
      resolve(lock !== null);
      // The lock is held until the page closes.
      return lock && new Promise(() => undefined);
    });
    held.catch((error: unknown) => {
      if (error instanceof DOMException && error.name === 'SecurityError') resolve(true);
      else reject(error);
    });
  });
}

/**
 * Resolves with the progress that was reported to the server, or with null if there is none or the server does not
 * answer; "replaced": the session is of a simulated study that another one has replaced.
 */
async function reportedProgress(
  client: ParticipantClient,
  session: KeptSession,
): Promise<Progress | null | 'replaced'> {
  try {
    return await client.progress(session);
  } catch (error) {
    if (session.simulated && error instanceof Rejection && error.reason === 'unauthorised') return 'replaced';
    if (error instanceof ServerUnreachable || error instanceof Rejection) return null;
    throw error;
  }
}

/**
 * Opens a participant's session on this device, from its storage whether the server answers or not, otherwise with the
 * server. Rejects with a sentence or with the refusal of the server.
 */
export async function openSession(place: StudyPlace, opening: OpeningOptions): Promise<OpenedSession> {
  const { participant } = place;
  const { client } = opening;
  if (!(await lockParticipant(place))) throw new PhrasedError('entrance.otherTab', { participant });
  const { vault, kept } = await readDevice(place, opening.storageLimitMs);
  const options = { ...opening, vault };
  const known = kept && (await reportedProgress(client, kept.session));
  if (known === 'replaced') await vault?.forget(place);
  else if (kept) {
    const later = known && isLater(scheduleFor(kept.session.plan, participant), known, kept.session.progress);
    const newest = later ? { ...kept.session, progress: known } : kept.session;
    const session = new ParticipantSession(newest, kept, options);
    session.apply({ type: 'reload' });
    return { kind: 'resumed', session };
  }
  const study = await client.study(place);
  return {
    kind: 'new',
    study,
    async agree(choices, invitation) {
      const { motion, language } = choices;
      const { version } = study.consent;
      try {
        const claimed = startSession(await client.claim(place, invitation, version), place);
        const begun = claimed.progress.motion !== null;
        const nothing = { records: [], motion: [] };
        const session = new ParticipantSession(begun ? withChoices(claimed, choices) : claimed, nothing, options);
        if (begun) {
          session.apply({ type: 'reload' });
          if (claimed.progress.motion && !motion) session.apply({ type: 'remark', text: noMotionHere });
          return session;
        }
        const rejection = session.apply({ type: 'consent', motion, version, ...(language !== null && { language }) });
        return rejection === null ? session : { why: rejection };
      } catch (error) {
        if (error instanceof Rejection && error.field === 'invitation') return 'uninvited';
        if (error instanceof Rejection && error.field === 'consent') return 'changed';
        if (error instanceof Rejection && error.reason === 'conflict')
          return { why: new PhrasedError('entrance.taken', { participant }) };
        return { why: error };
      }
    },
  };
}

/** Deletes everything of this participant from the device; rejects if its storage fails. */
export async function forgetSession(place: StudyPlace): Promise<void> {
  const vault = await openStudyVault();
  await vault.forget(place);
}
