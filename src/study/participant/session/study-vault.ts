import { type DBSchema, type IDBPDatabase, openDB } from 'idb';
import type { StudyPlan } from '../../model/plan/plan';
import type { Progress } from '../../model/progress/progress';
import type { ParticipantProfile } from '../../model/records/participant-profile';
import type { StudyRecord } from '../../model/records/study-record';
import { StorageTimeout } from './storage-timeout';

/** A session as this device stores it. */
export interface KeptSession extends ParticipantProfile {
  readonly study: string;
  readonly participant: string;
  readonly token: string;
  /** The withdrawal code; null: the participant has noted it. */
  readonly withdrawalCode: string | null;
  readonly plan: StudyPlan;
  readonly simulated: boolean;
  readonly progress: Progress;
}

/** A recording of a trial that waits for its upload. */
export interface KeptMotion {
  readonly trial: string;
  readonly recording: string;
}

interface Schema extends DBSchema {
  sessions: { key: [string, string]; value: KeptSession };
  records: {
    key: [string, string, string];
    value: { study: string; participant: string; id: string; record: StudyRecord };
  };
  motion: { key: [string, string, string]; value: KeptMotion & { study: string; participant: string } };
}

/** The session was deleted from the vault by another page of this browser, for example after a withdrawal. */
export class SessionForgotten extends Error {}

/**
 * Stores sessions, records and recordings in IndexedDB until the server has them. Every request rejects if the storage
 * does not answer within five seconds.
 */
export interface StudyVault {
  session(study: string, participant: string): Promise<KeptSession | null>;
  /**
   * Stores the session and new records in one transaction. Rejects if the device has no room, and with SessionForgotten
   * if it is saved `again` after it was deleted.
   */
  save(session: KeptSession, records: readonly StudyRecord[], again?: boolean): Promise<void>;
  /** Resolves with the records that the server has not acknowledged, in the order in which they were made. */
  records(study: string, participant: string): Promise<readonly StudyRecord[]>;
  removeRecords(study: string, participant: string, ids: readonly string[]): Promise<void>;
  saveMotion(study: string, participant: string, motion: KeptMotion): Promise<void>;
  motion(study: string, participant: string): Promise<readonly KeptMotion[]>;
  removeMotion(study: string, participant: string, trial: string): Promise<void>;
  /** Deletes everything of this participant from the device. */
  forget(study: string, participant: string): Promise<void>;
  close(): void;
}

/** The format of earlier versions, in which the number of the newest command was stored next to the progress. */
type EarlierSession = KeptSession & { readonly commandsSeen?: number };

function broughtUpToDate({ commandsSeen, ...session }: EarlierSession): KeptSession {
  if (commandsSeen === undefined) return session;
  return { ...session, progress: { commandsSeen, ...session.progress } };
}

const everyOf = (study: string, participant: string) =>
  IDBKeyRange.bound([study, participant, ''], [study, participant, '\uffff']);

/** Opens the vault; rejects if the browser has none, as some in private windows. */
export async function openStudyVault(name = 'threepoint-studies'): Promise<StudyVault> {
  const timeout = new StorageTimeout();
  const vault = databaseVault(
    await timeout.limit(() =>
      openDB<Schema>(name, 1, {
        upgrade(fresh) {
          fresh.createObjectStore('sessions', { keyPath: ['study', 'participant'] });
          fresh.createObjectStore('records', { keyPath: ['study', 'participant', 'id'] });
          fresh.createObjectStore('motion', { keyPath: ['study', 'participant', 'trial'] });
        },
      }),
    ),
  );
  const bounded =
    <Args extends readonly unknown[], Answer>(request: (...args: Args) => Promise<Answer>) =>
    (...args: Args): Promise<Answer> =>
      timeout.limit(() => request(...args));
  return {
    session: bounded(vault.session),
    save: bounded(vault.save),
    records: bounded(vault.records),
    removeRecords: bounded(vault.removeRecords),
    saveMotion: bounded(vault.saveMotion),
    motion: bounded(vault.motion),
    removeMotion: bounded(vault.removeMotion),
    forget: bounded(vault.forget),
    close: () => vault.close(),
  };
}

/** The vault in an open database, which waits for it however long that takes. */
function databaseVault(database: IDBPDatabase<Schema>): StudyVault {
  return {
    async session(study, participant) {
      const kept = await database.get('sessions', [study, participant]);
      return kept ? broughtUpToDate(kept) : null;
    },
    async save(session, records, again = false) {
      // With strict durability, resolved means written to the disk.
      const transaction = database.transaction(['sessions', 'records'], 'readwrite', { durability: 'strict' });
      const { study, participant } = session;
      const sessions = transaction.objectStore('sessions');
      if (again && (await sessions.getKey([study, participant])) === undefined) throw new SessionForgotten();
      await Promise.all([
        sessions.put(session),
        ...records.map((record) =>
          transaction.objectStore('records').put({ study, participant, id: record.id, record }),
        ),
        transaction.done,
      ]);
    },
    async records(study, participant) {
      const kept = await database.getAll('records', everyOf(study, participant));
      // Ids have no order. Among records of one moment, consent is first, because nothing may be stored before it.
      const rank = ({ kind }: StudyRecord) => (kind === 'consent' ? 0 : kind === 'event' ? 2 : 1);
      return kept.map(({ record }) => record).toSorted((a, b) => a.at - b.at || rank(a) - rank(b));
    },
    async removeRecords(study, participant, ids) {
      const transaction = database.transaction('records', 'readwrite');
      await Promise.all([...ids.map((id) => transaction.store.delete([study, participant, id])), transaction.done]);
    },
    async saveMotion(study, participant, motion) {
      await database.put('motion', { ...motion, study, participant });
    },
    motion: (study, participant) => database.getAll('motion', everyOf(study, participant)),
    removeMotion: (study, participant, trial) => database.delete('motion', [study, participant, trial]),
    async forget(study, participant) {
      const transaction = database.transaction(['sessions', 'records', 'motion'], 'readwrite');
      await Promise.all([
        transaction.objectStore('sessions').delete([study, participant]),
        transaction.objectStore('records').delete(everyOf(study, participant)),
        transaction.objectStore('motion').delete(everyOf(study, participant)),
        transaction.done,
      ]);
    },
    close: () => database.close(),
  };
}
