import { recordVersion, type StudyRecord } from '../../model/records/study-record';
import { StoreRefusal } from './store-refusal';
import type { StudyDatabase } from './study-database';
import { notConsented, type StudyPlaces } from './study-places';
import type { StudyPlans } from './study-plans';

export const maxRecordsPerParticipant = 10_000;

/** The prefix of the ids of the experimenter's remarks. */
const remarkPrefix = 'experimenter-';

/** The records of participants who have consented. */
export class StudyRecords {
  readonly #database: StudyDatabase;
  readonly #plans: StudyPlans;
  readonly #places: StudyPlaces;

  constructor(database: StudyDatabase, plans: StudyPlans, places: StudyPlaces) {
    this.#database = database;
    this.#plans = plans;
    this.#places = places;
  }

  /** Stores the new ones of these records in one transaction; returns the ids of all. */
  store(study: string, participant: string, records: readonly StudyRecord[], at: number): readonly string[] {
    const { simulated } = this.#plans.get(study);
    const plan = this.#plans.planFor(study, participant);
    return this.#database.transaction(() => {
      let { motion_consent: consented } = this.#places.getPresent(study, participant);
      for (const record of records) {
        refuseForeign(record, study, participant, simulated);
        if (record.kind === 'consent') refuseOtherText(record.body.version, plan.consent.version);
        else if (consented === null) throw notConsented(participant);
        // A repeated record changes nothing, because the consent to motion may have been withdrawn since.
        if (!this.#insert(record, at) || record.kind !== 'consent') continue;
        consented = Number(record.body.motion && plan.consent.motion !== null);
        this.#places.setMotionConsent(study, participant, consented);
      }
      return records.map(({ id }) => id);
    });
  }

  addRemark(study: string, participant: string, text: string, at: number): string {
    const { simulated } = this.#plans.get(study);
    return this.#database.transaction(() => {
      if (this.#places.getPresent(study, participant).motion_consent === null) throw notConsented(participant);
      const { next } = this.#database.getOne<{ next: number }>(
        'SELECT coalesce(max(number), 0) + 1 AS next FROM records',
      );
      const id = `${remarkPrefix}${next}`;
      const about = { version: recordVersion, id, study, participant, simulated, at } as const;
      this.#insert({ ...about, kind: 'event', body: { type: 'remark', text } }, at);
      return id;
    });
  }

  /** Returns the records of one participant, or of all. */
  all(study: string, participant?: string): readonly StudyRecord[] {
    const rows =
      participant === undefined
        ? this.#database.all<{ record: string }>(
            'SELECT record FROM records WHERE study = ? ORDER BY participant, number',
            study,
          )
        : this.#database.all<{ record: string }>(
            'SELECT record FROM records WHERE study = ? AND participant = ? ORDER BY number',
            ...[study, participant],
          );
    return rows.map(({ record }) => JSON.parse(record) as StudyRecord);
  }

  /**
   * Returns the records of these participants as a JSON list without parsing them, because those of a whole study may
   * fill the memory.
   */
  listed(study: string, participants: ReadonlySet<string>): readonly Uint8Array[] {
    const chunks: Buffer[] = [];
    const rows = this.#database.each<{ participant: string; record: string }>(
      'SELECT participant, record FROM records WHERE study = ? ORDER BY participant, number',
      study,
    );
    for (const { participant, record } of rows) {
      if (!participants.has(participant)) continue;
      chunks.push(Buffer.from(`${chunks.length === 0 ? '[' : ','}${record}`));
    }
    chunks.push(Buffer.from(chunks.length === 0 ? '[]' : ']'));
    return chunks;
  }

  count(study: string, participant: string): number {
    return this.#database.getOne<{ count: number }>(
      'SELECT count(*) AS count FROM records WHERE study = ? AND participant = ?',
      ...[study, participant],
    ).count;
  }

  /** Deletes the records of a participant, in a transaction; returns their number. */
  delete(study: string, participant: string): number {
    return this.#database.run('DELETE FROM records WHERE study = ? AND participant = ?', study, participant);
  }

  /** Stores a record, in a transaction; returns false if it is stored already. */
  #insert(record: StudyRecord, receivedAt: number): boolean {
    const { study, participant, id } = record;
    const text = JSON.stringify(record);
    const stored = this.#database.get<{ record: string }>(
      'SELECT record FROM records WHERE study = ? AND participant = ? AND id = ?',
      ...[study, participant, id],
    );
    if (stored) {
      if (stored.record === text) return false;
      throw new StoreRefusal('conflict', `${participant} has stored something else as "${id}" already`);
    }
    if (this.count(study, participant) >= maxRecordsPerParticipant) {
      throw new StoreRefusal('full', `${participant} has ${maxRecordsPerParticipant} records already`);
    }
    this.#database.run(
      'INSERT INTO records (study, participant, id, record, received_at) VALUES (?, ?, ?, ?, ?)',
      ...[study, participant, id, text, receivedAt],
    );
    return true;
  }
}

function refuseOtherText(read: unknown, shown: string): void {
  if (read === shown) return;
  throw new StoreRefusal('conflict', `consent is to text ${read}, the study shows ${shown}`);
}

/**
 * Refuses a record of another place, with the id of an experimenter's remark, or of a person in a simulated study and
 * the reverse.
 */
function refuseForeign(record: StudyRecord, study: string, participant: string, simulated: boolean): void {
  if (record.study !== study || record.participant !== participant) {
    throw new StoreRefusal('forbidden', `"${record.id}" is of ${record.participant} in "${record.study}"`);
  }
  if (record.id.startsWith(remarkPrefix)) {
    throw new StoreRefusal('forbidden', `"${record.id}" is the name of an experimenter's remark`);
  }
  if (record.simulated !== simulated) {
    throw new StoreRefusal(
      'forbidden',
      `the study "${study}" is ${simulated ? 'simulated' : 'of people'}, "${record.id}" is not`,
    );
  }
}
