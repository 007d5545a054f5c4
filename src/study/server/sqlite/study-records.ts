import { Rejection } from '../../model/progress/rejection';
import type { StudyCommand } from '../../model/progress/study-api';
import {
  type RecordAuthor,
  recordVersion,
  type StoredRecord,
  type StudyEvent,
  type StudyRecord,
} from '../../model/records/study-record';
import type { RecordStorage } from '../study-storage';
import type { StudyCommands } from './study-commands';
import type { StudyDatabase } from './study-database';
import { notConsented, type StudyPlaces } from './study-places';
import type { StudyPlans } from './study-plans';

export const maxRecordsPerParticipant = 10_000;

/** The prefix of the ids of the experimenter's remarks. */
const remarkPrefix = 'experimenter-';

interface RecordRow {
  /** The record as JSON. */
  readonly record: string;
  readonly author: RecordAuthor;
  readonly received_at: number;
}

/** Returns a record as JSON, with the fields that the server adds. */
function storedJson({ record, author, received_at }: RecordRow): string {
  const added = JSON.stringify({ author, receivedAt: received_at });
  return `${record.slice(0, -1)},${added.slice(1)}`;
}

export class StudyRecords implements RecordStorage {
  readonly #database: StudyDatabase;
  readonly #plans: StudyPlans;
  readonly #places: StudyPlaces;
  readonly #commands: StudyCommands;

  constructor(database: StudyDatabase, plans: StudyPlans, places: StudyPlaces, commands: StudyCommands) {
    this.#database = database;
    this.#plans = plans;
    this.#places = places;
    this.#commands = commands;
  }

  store(
    study: string,
    participant: string,
    records: readonly StudyRecord[],
    at: number,
    author: RecordAuthor = 'participant',
  ): readonly string[] {
    const { simulated } = this.#plans.get(study);
    const plan = this.#plans.planFor(study, participant);
    return this.#database.transaction(() => {
      let { motion_consent: consented } = this.#places.getPresent(study, participant);
      for (const record of records) {
        rejectForeign(record, study, participant, simulated);
        if (record.kind === 'consent') rejectOtherText(record.body.version, plan.consent.version);
        else if (consented === null) throw notConsented(participant);
        // A repeated record changes nothing, because the consent to motion may have been withdrawn since.
        if (!this.#insert(record, author, at)) continue;
        if (author === 'participant') this.#rejectUncommanded(record);
        if (record.kind !== 'consent') continue;
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
      this.#insert({ ...about, kind: 'event', body: { type: 'remark', text } }, 'experimenter', at);
      return id;
    });
  }

  /** Stores that a participant has withdrawn the consent to motion, in a transaction. */
  addMotionWithdrawal(study: string, participant: string, at: number): void {
    const { simulated } = this.#plans.get(study);
    const about = { version: recordVersion, id: 'motion-withdrawn', study, participant, simulated, at } as const;
    this.#insert({ ...about, kind: 'event', body: { type: 'motion-withdrawn' } }, 'participant', at);
  }

  all(study: string, participant?: string): readonly StoredRecord[] {
    const rows =
      participant === undefined
        ? this.#database.all<RecordRow>('SELECT * FROM records WHERE study = ? ORDER BY participant, number', study)
        : this.#database.all<RecordRow>(
            'SELECT * FROM records WHERE study = ? AND participant = ? ORDER BY number',
            ...[study, participant],
          );
    return rows.map((row) => JSON.parse(storedJson(row)) as StoredRecord);
  }

  listed(study: string, participants: ReadonlySet<string>): readonly Uint8Array[] {
    const chunks: Buffer[] = [];
    const rows = this.#database.each<RecordRow & { readonly participant: string }>(
      'SELECT * FROM records WHERE study = ? ORDER BY participant, number',
      study,
    );
    for (const row of rows) {
      if (!participants.has(row.participant)) continue;
      chunks.push(Buffer.from(`${chunks.length === 0 ? '[' : ','}${storedJson(row)}`));
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
  #insert(record: StudyRecord, author: RecordAuthor, receivedAt: number): boolean {
    const { study, participant, id } = record;
    const text = JSON.stringify(record);
    const stored = this.#database.get<{ record: string }>(
      'SELECT record FROM records WHERE study = ? AND participant = ? AND id = ?',
      ...[study, participant, id],
    );
    if (stored) {
      if (stored.record === text) return false;
      throw new Rejection('conflict', `${participant} has stored something else as "${id}" already`);
    }
    if (this.count(study, participant) >= maxRecordsPerParticipant) {
      throw new Rejection('full', `${participant} has ${maxRecordsPerParticipant} records already`);
    }
    this.#database.run(
      'INSERT INTO records (study, participant, id, record, received_at, author) VALUES (?, ?, ?, ?, ?, ?)',
      ...[study, participant, id, text, receivedAt, author],
    );
    return true;
  }

  /**
   * Refuses, in the transaction that has stored it, an event that only the experimenter causes: a participant's page
   * records one for each command.
   */
  #rejectUncommanded({ id, study, participant, ...record }: StudyRecord): void {
    if (record.kind !== 'event' || !isCommanded(record.body)) return;
    const { body } = record;
    const given = this.#commands.after(study, participant, 0).filter(({ command }) => hasCaused(command, body));
    const events = this.all(study, participant).filter((one) => one.kind === 'event' && isSameEvent(one.body, body));
    if (events.length <= given.length) return;
    throw new Rejection('forbidden', `"${id}" follows from no command of the experimenter`);
  }
}

type CommandedEvent = Extract<StudyEvent, { readonly type: 'void-block' | 'stop' }>;

const isCommanded = (event: StudyEvent): event is CommandedEvent =>
  event.type === 'void-block' || (event.type === 'stop' && event.by === 'experimenter');

const isSameEvent = (one: StudyEvent, other: CommandedEvent): boolean =>
  isCommanded(one) && JSON.stringify({ ...one, run: 0 }) === JSON.stringify({ ...other, run: 0 });

function hasCaused(command: StudyCommand, event: CommandedEvent): boolean {
  if (command.type === 'stop') return event.type === 'stop' && event.reason === command.reason;
  if (command.type !== 'void-block' || event.type !== 'void-block') return false;
  const { reason, repeat, of = event } = command;
  return event.reason === reason && event.repeat === repeat && event.task === of.task && event.block === of.block;
}

function rejectOtherText(read: unknown, shown: string): void {
  if (read === shown) return;
  throw new Rejection('conflict', `consent is to text ${read}, the study shows ${shown}`);
}

/**
 * Refuses a record of another place, with the id of an experimenter's remark, or of a person in a simulated study and
 * the reverse.
 */
function rejectForeign(record: StudyRecord, study: string, participant: string, simulated: boolean): void {
  if (record.study !== study || record.participant !== participant) {
    throw new Rejection('forbidden', `"${record.id}" is of ${record.participant} in "${record.study}"`);
  }
  if (record.id.startsWith(remarkPrefix)) {
    throw new Rejection('forbidden', `"${record.id}" is the name of an experimenter's remark`);
  }
  if (record.simulated !== simulated) {
    throw new Rejection(
      'forbidden',
      `the study "${study}" is ${simulated ? 'simulated' : 'of people'}, "${record.id}" is not`,
    );
  }
}
