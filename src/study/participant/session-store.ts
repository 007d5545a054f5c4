import { reasonOf } from 'threepoint/core/errors/reasons';
import type { StudyRecord } from '../model/records/study-record';
import { type KeptMotion, type KeptSession, SessionForgotten, type StudyVault } from './study-vault';

/** What an earlier visit of the page left in the vault. */
export interface Unsent {
  readonly records: readonly StudyRecord[];
  readonly motion: readonly KeptMotion[];
}

/** Bodies of the server are 512 KiB at most; a batch stays well below [characters, records]. */
const longestBatch = 300_000;
const largestBatch = 100;

/** Why a browser without IndexedDB stores nothing. */
export const noStorage = 'this browser offers no storage';

/** A session and what it recorded, on this device until the server has it: in memory at once, in the vault as soon as that can be. */
export class SessionStore {
  readonly #vault: StudyVault | null;
  readonly #onChange: () => void;
  #session: KeptSession;
  /** The session as the vault has it. */
  #saved: KeptSession;
  /** What the server has not acknowledged, by id and by trial. */
  readonly #records: Map<string, StudyRecord>;
  readonly #motion: Map<string, KeptMotion>;
  /** What the vault does not have yet. */
  #unsaved: readonly StudyRecord[] = [];
  readonly #unsavedMotion = new Map<string, KeptMotion>();
  #fault: string | null;
  /** Whether this page has stored the session, and whether another one has deleted it since: then nothing of it is stored any more. */
  #stored = false;
  #forgotten = false;
  #saving: Promise<void> = Promise.resolve();

  /** `vault` null: this browser stores nothing. `onChange` hears of every change, and of every attempt to store it. */
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
    this.#fault = vault ? null : noStorage;
    this.#onChange = onChange;
  }

  get session(): KeptSession {
    return this.#session;
  }

  /** Records and recordings that the server has not acknowledged. */
  get unsent(): number {
    return this.#records.size + this.#motion.size;
  }

  /** Of these, how many are in the memory of the page alone. */
  get unsaved(): number {
    if (this.#forgotten) return 0;
    return this.#vault ? this.#unsaved.length + this.#unsavedMotion.size : this.unsent;
  }

  /** Why the device could not store; null: it can. */
  get fault(): string | null {
    return this.#fault;
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

  /** One attempt after another; what fails stays unsaved and is tried again with the next. Resolves when this one is over; never rejects. */
  save(): Promise<void> {
    this.#saving = this.#saving.then(() => this.#saveOnce());
    return this.#saving;
  }

  /** Resolves when the device has stored everything so far, or has said that it cannot. */
  settled(): Promise<void> {
    return this.#saving;
  }

  /** The device failed in another way than by a save, which goes on as before. */
  noteFault(error: unknown): void {
    this.#fault = reasonOf(error);
  }

  /** As many records as one request may hold, the oldest first; empty: there are none but those `left` out. */
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

  /** The server has these records. */
  async acknowledge(ids: readonly string[]): Promise<void> {
    for (const id of ids) this.#records.delete(id);
    this.#unsaved = this.#unsaved.filter(({ id }) => !ids.includes(id));
    await this.#remove((vault, { study, participant }) => vault.removeRecords(study, participant, ids));
  }

  /** The server has the recording of this trial. */
  async acknowledgeMotion(trial: string): Promise<void> {
    this.#motion.delete(trial);
    this.#unsavedMotion.delete(trial);
    await this.#remove((vault, { study, participant }) => vault.removeMotion(study, participant, trial));
  }

  /** What stays because the device fails is sent again by a later visit, and the server keeps it once. */
  async #remove(from: (vault: StudyVault, session: KeptSession) => Promise<void>): Promise<void> {
    // What the save under way still writes must be removed after it.
    await this.#saving;
    if (this.#vault) await from(this.#vault, this.#session).catch((error: unknown) => this.noteFault(error));
    this.#onChange();
  }

  async #saveOnce(): Promise<void> {
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
        await vault.saveMotion(session.study, session.participant, motion);
        this.#unsavedMotion.delete(motion.trial);
      }
      this.#fault = null;
    } catch (error) {
      if (error instanceof SessionForgotten) this.#forgotten = true;
      else this.#fault = reasonOf(error);
    }
    this.#onChange();
  }
}
