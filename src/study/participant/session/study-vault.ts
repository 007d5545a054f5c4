import { type DBSchema, type IDBPDatabase, openDB } from 'idb';
import type { StudyPlace, TakenPlace } from '../../client/study-client';
import type { StudyPlan } from '../../model/plan/plan';
import type { Progress } from '../../model/progress/progress';
import type { ParticipantProfile } from '../../model/records/participant-profile';
import type { StudyRecord } from '../../model/records/study-record';
import { StorageTimeout } from './storage-timeout';

export interface KeptSession extends TakenPlace, ParticipantProfile {
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

/** The browser has closed the vault and deleted its data, for example for want of room. It is open again, and empty. */
export class StorageEvicted extends Error {
  constructor() {
    super('the browser has deleted what was stored on this device');
  }
}

const everyOf = ({ study, participant }: StudyPlace) =>
  IDBKeyRange.bound([study, participant, ''], [study, participant, '\uffff']);

/**
 * Stores sessions, records and recordings in IndexedDB until the server has them. Every request rejects if the storage
 * does not answer within five seconds, and with StorageEvicted after its data were deleted.
 */
export class StudyVault {
  #database: IDBPDatabase<Schema>;
  readonly #timeout: StorageTimeout;
  readonly #open: () => Promise<IDBPDatabase<Schema>>;

  /** `open` opens the database again after an eviction. */
  constructor(database: IDBPDatabase<Schema>, timeout: StorageTimeout, open: () => Promise<IDBPDatabase<Schema>>) {
    this.#database = database;
    this.#timeout = timeout;
    this.#open = open;
  }

  session({ study, participant }: StudyPlace): Promise<KeptSession | null> {
    return this.#request(async () => (await this.#database.get('sessions', [study, participant])) ?? null);
  }

  /**
   * Stores the session and new records in one transaction. Rejects if the device has no room, and with SessionForgotten
   * if it is saved `again` after it was deleted.
   */
  save(session: KeptSession, records: readonly StudyRecord[], again = false): Promise<void> {
    return this.#request(async () => {
      // With strict durability, resolved means written to the disk.
      const transaction = this.#database.transaction(['sessions', 'records'], 'readwrite', { durability: 'strict' });
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
    });
  }

  /** Resolves with the records that the server has not acknowledged, in the order in which they were made. */
  records(place: StudyPlace): Promise<readonly StudyRecord[]> {
    return this.#request(async () => {
      const kept = await this.#database.getAll('records', everyOf(place));
      // Ids have no order. Among records of one moment, consent is first, because nothing may be stored before it.
      const rank = ({ kind }: StudyRecord) => (kind === 'consent' ? 0 : kind === 'event' ? 2 : 1);
      return kept.map(({ record }) => record).toSorted((a, b) => a.at - b.at || rank(a) - rank(b));
    });
  }

  removeRecords({ study, participant }: StudyPlace, ids: readonly string[]): Promise<void> {
    return this.#request(async () => {
      const transaction = this.#database.transaction('records', 'readwrite');
      await Promise.all([...ids.map((id) => transaction.store.delete([study, participant, id])), transaction.done]);
    });
  }

  async saveMotion({ study, participant }: StudyPlace, motion: KeptMotion): Promise<void> {
    await this.#request(() => this.#database.put('motion', { ...motion, study, participant }));
  }

  motion(place: StudyPlace): Promise<readonly KeptMotion[]> {
    return this.#request(() => this.#database.getAll('motion', everyOf(place)));
  }

  removeMotion({ study, participant }: StudyPlace, trial: string): Promise<void> {
    return this.#request(() => this.#database.delete('motion', [study, participant, trial]));
  }

  forget(place: StudyPlace): Promise<void> {
    return this.#request(async () => {
      const transaction = this.#database.transaction(['sessions', 'records', 'motion'], 'readwrite');
      await Promise.all([
        transaction.objectStore('sessions').delete([place.study, place.participant]),
        transaction.objectStore('records').delete(everyOf(place)),
        transaction.objectStore('motion').delete(everyOf(place)),
        transaction.done,
      ]);
    });
  }

  close(): void {
    this.#database.close();
  }

  async #request<Answer>(request: () => Promise<Answer>): Promise<Answer> {
    try {
      return await this.#timeout.limit(request);
    } catch (error) {
      if ((error as Error).name !== 'InvalidStateError') throw error;
      this.#database = await this.#timeout.limit(this.#open);
      throw new StorageEvicted();
    }
  }
}

/**
 * Opens the vault; rejects if the browser has none, as some in private windows. `limitMs` is the time limit of each
 * request [ms].
 */
export async function openStudyVault(name = 'threepoint-studies', limitMs?: number): Promise<StudyVault> {
  const timeout = new StorageTimeout(limitMs);
  const open = () =>
    openDB<Schema>(name, 1, {
      upgrade(fresh) {
        fresh.createObjectStore('sessions', { keyPath: ['study', 'participant'] });
        fresh.createObjectStore('records', { keyPath: ['study', 'participant', 'id'] });
        fresh.createObjectStore('motion', { keyPath: ['study', 'participant', 'trial'] });
      },
    });
  return new StudyVault(await timeout.limit(open), timeout, open);
}
