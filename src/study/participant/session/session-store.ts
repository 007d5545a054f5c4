import { reasonOf } from 'threepoint/core';
import type { StudyRecord } from '../../model/records/study-record';
import { type KeptMotion, type KeptSession, SessionForgotten, StorageEvicted, type StudyVault } from './study-vault';

/** The data that an earlier visit of the page left in the vault. */
export interface Unsent {
  readonly records: readonly StudyRecord[];
  readonly motion: readonly KeptMotion[];
}

/** The limits of a batch [characters, records], well below the 512 KiB that the server accepts. */
const longestBatch = 300_000;
const largestBatch = 100;

/** The reason why a browser without IndexedDB stores nothing. */
export const noStorage = 'this browser offers no storage';

/**
 * Keeps a session and its records on this device until the server has them: in memory at once, in the vault as soon as
 * possible.
 */
export class SessionStore {
  readonly #vault: StudyVault | null;
  readonly #onChange: () => void;
  #session: KeptSession;
  #saved: KeptSession;
  /** The records and recordings that the server has not acknowledged, by id and by trial. */
  readonly #records: Map<string, StudyRecord>;
  readonly #motion: Map<string, KeptMotion>;
  /** The records that are not in the vault yet. */
  #unsaved: readonly StudyRecord[] = [];
  readonly #unsavedMotion = new Map<string, KeptMotion>();
  #problem: string | null;
  /** Whether this page has stored the session. If another page has deleted it since, it is not stored again. */
  #stored = false;
  #forgotten = false;
  #saving: Promise<void> = Promise.resolve();

  /**
   * `vault` null: the browser stores nothing. `onChange` is called after every change and after every attempt to store
   * it.
   */
  constructor(
    kept: KeptSession,
    { records, motion }: Unsent,
    { vault, onChange }: { readonly vault: StudyVault | null; readonly onChange: () => void },
  ) {
    this.#session = kept;
    this.#saved = kept;
    this.#records = new Map(records.map((record) => [record.id, record]));
    this.#motion = new Map(motion.map((one) => [one.trial, one]));
    this.#vault = vault;
    this.#problem = vault ? null : noStorage;
    this.#onChange = onChange;
  }

  get session(): KeptSession {
    return this.#session;
  }

  /** The number of records and recordings that the server has not acknowledged. */
  get unsent(): number {
    return this.#records.size + this.#motion.size;
  }

  /** The number of these that are only in the memory of the page. */
  get unsaved(): number {
    if (this.#forgotten) return 0;
    return this.#vault ? this.#unsaved.length + this.#unsavedMotion.size : this.unsent;
  }

  /** Why the device could not store them; null: it could. */
  get problem(): string | null {
    return this.#problem;
  }

  /** The recordings that the server has not acknowledged. */
  get motion(): readonly KeptMotion[] {
    return [...this.#motion.values()];
  }

  change(next: KeptSession, records: readonly StudyRecord[] = []): void {
    this.#session = next;
    for (const record of records) this.#records.set(record.id, record);
    this.#unsaved = [...this.#unsaved, ...records];
    void this.save();
    this.#onChange();
  }

  keepMotion(motion: KeptMotion): void {
    this.#motion.set(motion.trial, motion);
    this.#unsavedMotion.set(motion.trial, motion);
    void this.save();
    this.#onChange();
  }

  /**
   * Stores what is unsaved, one attempt after another; a failed one is repeated with the next. Resolves when this
   * attempt is over; never rejects.
   */
  save(): Promise<void> {
    this.#saving = this.#saving.then(() => this.#saveOnce());
    return this.#saving;
  }

  /** Resolves when the device has stored everything so far or has reported that it cannot. */
  settled(): Promise<void> {
    return this.#saving;
  }

  /** Reports a fault of the device outside of a save. After an eviction, the next save stores everything once more. */
  noteProblem(error: unknown): void {
    this.#problem = reasonOf(error);
    if (!(error instanceof StorageEvicted)) return;
    this.#stored = false;
    this.#unsaved = [...this.#records.values()];
    for (const motion of this.#motion.values()) this.#unsavedMotion.set(motion.trial, motion);
  }

  /** Returns the oldest unsent records that fit one request, without those `left` out; empty: there are none. */
  nextBatch(left: ReadonlySet<string>): readonly StudyRecord[] {
    const batch: StudyRecord[] = [];
    let length = 0;
    for (const record of this.#records.values()) {
      if (left.has(record.id)) continue;
      length += JSON.stringify(record).length;
      if (batch.length > 0 && (length > longestBatch || batch.length >= largestBatch)) break;
      batch.push(record);
    }
    return batch;
  }

  async acknowledge(ids: readonly string[]): Promise<void> {
    for (const id of ids) this.#records.delete(id);
    this.#unsaved = this.#unsaved.filter(({ id }) => !ids.includes(id));
    await this.#remove((vault, session) => vault.removeRecords(session, ids));
  }

  async acknowledgeMotion(trial: string): Promise<void> {
    this.#motion.delete(trial);
    this.#unsavedMotion.delete(trial);
    await this.#remove((vault, session) => vault.removeMotion(session, trial));
  }

  /** Discards the recordings that were not sent. */
  async discardMotion(): Promise<void> {
    for (const trial of [...this.#motion.keys()]) await this.acknowledgeMotion(trial);
  }

  /** What stays because the device fails is sent again by a later visit, and the server keeps it once. */
  async #remove(from: (vault: StudyVault, session: KeptSession) => Promise<void>): Promise<void> {
    // What the save under way still writes must be removed after it.
    await this.#saving;
    if (this.#vault) await from(this.#vault, this.#session).catch((error: unknown) => this.noteProblem(error));
    this.#onChange();
  }

  async #saveOnce(isRepeated = false): Promise<void> {
    const vault = this.#forgotten ? null : this.#vault;
    const session = this.#session;
    const records = this.#unsaved;
    if (!vault || (records.length === 0 && this.#unsavedMotion.size === 0 && this.#saved === session)) return;
    try {
      await vault.save(session, records, this.#stored);
      this.#stored = true;
      this.#unsaved = this.#unsaved.filter((record) => !records.includes(record));
      this.#saved = session;
      for (const motion of [...this.#unsavedMotion.values()]) {
        await vault.saveMotion(session, motion);
        this.#unsavedMotion.delete(motion.trial);
      }
      this.#problem = null;
    } catch (error) {
      if (error instanceof SessionForgotten) this.#forgotten = true;
      else this.noteProblem(error);
      if (error instanceof StorageEvicted && !isRepeated) await this.#saveOnce(true);
    }
    this.#onChange();
  }
}
