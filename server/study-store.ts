import { createHash, randomBytes, timingSafeEqual } from 'node:crypto';
import { gunzipSync, gzipSync } from 'node:zlib';
import { DatabaseSync } from '@photostructure/sqlite';
import { checkedPlan, participantsOf, type StudyPlan, scheduleFor } from '../src/core/study/plan';
import { currentStep, type Progress, remainingSeconds, resumed } from '../src/core/study/progress';
import type { ParticipantState, Receipt, StudyCommand, StudyInfo } from '../src/core/study/study-api';
import { recordVersion, type StudyRecord } from '../src/core/study/study-record';
import type { MotionFile } from './study-export';
import { migrate, newCode, normalisedCode } from './study-schema';

/** Why the store will not do it; the message is for the person who asked. */
export class StoreRefusal extends Error {
  readonly reason: 'unknown' | 'conflict' | 'forbidden' | 'full';

  constructor(reason: StoreRefusal['reason'], message: string) {
    super(message);
    this.reason = reason;
  }
}

/**
 * Studies and what was recorded in them. Everything that returns has been written through to the disk. Times are seconds
 * since 1970, given by the caller.
 */
export interface StudyStore {
  /** Adds a study, or finds the same one there; refuses another plan under the id of a study that has begun. */
  addStudy(plan: StudyPlan, options: { readonly simulated: boolean; readonly at: number }): StudyInfo;
  study(id: string): StudyInfo;
  studies(): readonly StudyInfo[];
  /** Whether this is the invitation to the place, however it was typed. */
  invites(study: string, participant: string, code: string): boolean;
  /** Another invitation to the place, in an open study to all of them; the old one opens nothing any more. */
  reinvite(study: string, participant: string): void;
  /** Gives a place that is free away. The withdrawal code comes with the first claim alone; null later. */
  claim(
    study: string,
    participant: string,
    at: number,
  ): { readonly token: string; readonly withdrawalCode: string | null };
  /** Another device may claim the place; the old token is void, what was recorded stays. */
  release(study: string, participant: string): void;
  /** Whether this is the participant's token. */
  holds(study: string, participant: string, token: string): boolean;
  /** Stores what is not there yet, all or nothing; returns the ids of all. */
  storeRecords(study: string, participant: string, records: readonly StudyRecord[], at: number): readonly string[];
  records(study: string, participant?: string): readonly StudyRecord[];
  /** A remark of the experimenter, as a record of the participant. */
  addRemark(study: string, participant: string, text: string, at: number): string;
  saveProgress(study: string, participant: string, progress: unknown, at: number): void;
  progress(study: string, participant: string): Progress | null;
  /** Returns the command's number. */
  addCommand(study: string, participant: string, command: StudyCommand, at: number): number;
  /** Commands after this number, oldest first. */
  commands(
    study: string,
    participant: string,
    after: number,
  ): readonly { readonly number: number; readonly at: number; readonly command: StudyCommand }[];
  /** Keeps the tracked frames of a trial; refuses without consent to that. */
  storeMotion(study: string, participant: string, trial: string, text: string, at: number): void;
  motion(study: string, participant?: string): readonly MotionFile[];
  overview(study: string, now: number): readonly ParticipantState[];
  deleteParticipant(study: string, participant: string, reason: Receipt['reason'], at: number): Receipt;
  /** Deletes everything of the participant who has this code; null: none has. */
  withdraw(study: string, code: string, at: number): Receipt | null;
  /** Deletes what is past its retention date. */
  deleteExpired(now: number): readonly Receipt[];
  receipts(study: string): readonly Receipt[];
  close(): void;
}

export const mostRecordsPerParticipant = 10_000;
/** Compressed bytes of tracked frames. */
export const mostMotionPerParticipant = 256 * 2 ** 20;
export const mostCommandsPerParticipant = 10_000;

const secondsPerDay = 86_400;
const hashOf = (secret: string) => createHash('sha256').update(secret).digest();
const newToken = () => randomBytes(32).toString('base64url');

interface ParticipantRow {
  readonly participant: string;
  readonly token_hash: Uint8Array | null;
  readonly withdrawal_hash: Uint8Array | null;
  readonly invitation: string | null;
  readonly withdrawn: number;
  readonly motion_consent: number | null;
  readonly progress: string | null;
  readonly progress_at: number | null;
}

/** SQLite's codes: the disk, or what the database may take of it, is full; 4874: no room for the index of its log. */
const diskIsFull = new Set([13, 4874]);

/** The refusal of what failed for want of room; any other error as it is. */
function asRefusal(error: unknown): unknown {
  const { sqliteExtendedCode } = (error ?? {}) as { sqliteExtendedCode?: unknown };
  return typeof sqliteExtendedCode === 'number' && diskIsFull.has(sqliteExtendedCode)
    ? new StoreRefusal('full', 'the disk of the server is full: nothing of this was stored')
    : error;
}

/**
 * Opens the database in this file, makes it where there is none, and brings it up to date. It grows to `mostBytes`, so that studies leave
 * room for the rest of the machine; beyond that writes are refused as "full".
 */
export function openStudyStore(file: string, { mostBytes = 16 * 2 ** 30 } = {}): StudyStore {
  const database = new DatabaseSync(file);
  // FULL: what was acknowledged survives a power cut too. secure_delete: what was deleted is overwritten.
  database.exec(`
    PRAGMA journal_mode = WAL;
    PRAGMA synchronous = FULL;
    PRAGMA foreign_keys = ON;
    PRAGMA secure_delete = ON;
    PRAGMA busy_timeout = 5000;
  `);
  const { page_size: pageBytes } = database.prepare('PRAGMA page_size').get() as { page_size: number };
  database.exec(`PRAGMA max_page_count = ${Math.floor(mostBytes / pageBytes)}`);
  migrate(database);

  function transaction<T>(body: () => T): T {
    try {
      database.exec('BEGIN IMMEDIATE');
      const result = body();
      database.exec('COMMIT');
      return result;
    } catch (error) {
      // A full disk has rolled back already.
      if (database.isTransaction) database.exec('ROLLBACK');
      throw asRefusal(error);
    }
  }

  const sql = {
    study: database.prepare('SELECT * FROM studies WHERE id = ?'),
    studies: database.prepare('SELECT * FROM studies ORDER BY created_at, id'),
    participant: database.prepare('SELECT * FROM participants WHERE study = ? AND participant = ?'),
    record: database.prepare('SELECT record FROM records WHERE study = ? AND participant = ? AND id = ?'),
    insertRecord: database.prepare(
      'INSERT INTO records (study, participant, id, record, received_at) VALUES (?, ?, ?, ?, ?)',
    ),
    countRecords: database.prepare('SELECT count(*) AS count FROM records WHERE study = ? AND participant = ?'),
  };

  const infoOf = (row: Record<string, unknown>): StudyInfo => ({
    plan: checkedPlan(JSON.parse(row.plan as string)),
    simulated: row.simulated === 1,
    createdAt: row.created_at as number,
    retentionUntil: row.retention_until as number,
  });

  function studyOf(id: string): StudyInfo {
    const row = sql.study.get(id);
    if (!row) throw new StoreRefusal('unknown', `there is no study "${id}"`);
    return infoOf(row);
  }

  function participantOf(study: string, participant: string): ParticipantRow {
    const row = sql.participant.get(study, participant);
    if (!row) throw new StoreRefusal('unknown', `the study "${study}" has no participant ${participant}`);
    return row as ParticipantRow;
  }

  function presentParticipant(study: string, participant: string): ParticipantRow {
    const row = participantOf(study, participant);
    if (row.withdrawn) throw new StoreRefusal('forbidden', `${participant} has withdrawn`);
    return row;
  }

  const countRecords = (study: string, participant: string) =>
    (sql.countRecords.get(study, participant) as { count: number }).count;

  /** Inside a transaction. */
  function insertRecord(record: StudyRecord, receivedAt: number): void {
    const { study, participant, id } = record;
    const text = JSON.stringify(record);
    const stored = sql.record.get(study, participant, id) as { record: string } | undefined;
    if (stored) {
      if (stored.record === text) return;
      throw new StoreRefusal('conflict', `${participant} has stored something else as "${id}" already`);
    }
    if (countRecords(study, participant) >= mostRecordsPerParticipant) {
      throw new StoreRefusal('full', `${participant} has ${mostRecordsPerParticipant} records already`);
    }
    sql.insertRecord.run(study, participant, id, text, receivedAt);
  }

  function recordsOf(study: string, participant?: string): readonly StudyRecord[] {
    const rows =
      participant === undefined
        ? database.prepare('SELECT record FROM records WHERE study = ? ORDER BY participant, number').all(study)
        : database
            .prepare('SELECT record FROM records WHERE study = ? AND participant = ? ORDER BY number')
            .all(study, participant);
    return (rows as { record: string }[]).map(({ record }) => JSON.parse(record) as StudyRecord);
  }

  const receiptOf = (row: Record<string, unknown>): Receipt => ({
    number: row.number as number,
    study: row.study as string,
    participant: row.participant as string,
    reason: row.reason as Receipt['reason'],
    records: row.records as number,
    motionFiles: row.motion_files as number,
    at: row.at as number,
  });

  function deleteParticipant(study: string, participant: string, reason: Receipt['reason'], at: number): Receipt {
    const receipt = transaction(() => {
      const before = participantOf(study, participant);
      const of = [study, participant];
      const { changes: records } = database
        .prepare('DELETE FROM records WHERE study = ? AND participant = ?')
        .run(...of);
      const { changes: motionFiles } = database
        .prepare('DELETE FROM motion WHERE study = ? AND participant = ?')
        .run(...of);
      database.prepare('DELETE FROM commands WHERE study = ? AND participant = ?').run(...of);
      // A participant who withdrew stays out; a place that the experimenter cleared may be taken anew, by a new invitation.
      const open = studyOf(study).plan.entry === 'open';
      const invitation = reason !== 'experimenter' ? null : open ? before.invitation : newCode();
      database
        .prepare(
          `UPDATE participants SET token_hash = NULL, withdrawal_hash = NULL, motion_consent = NULL, progress = NULL,
           progress_at = NULL, withdrawn = ?, invitation = ? WHERE study = ? AND participant = ?`,
        )
        .run(reason === 'withdrawn' ? 1 : 0, invitation, ...of);
      const row = database
        .prepare(
          `INSERT INTO receipts (study, participant, reason, records, motion_files, at) VALUES (?, ?, ?, ?, ?, ?)
           RETURNING *`,
        )
        .get(study, participant, reason, records, motionFiles, at);
      return receiptOf(row);
    });
    // The log still holds the pages as they were.
    database.exec('PRAGMA wal_checkpoint(TRUNCATE)');
    return receipt;
  }

  return {
    addStudy(plan, { simulated, at }) {
      return transaction(() => {
        const checked = checkedPlan(plan);
        const text = JSON.stringify(checked);
        const stored = sql.study.get(checked.id);
        if (stored && stored.simulated !== Number(simulated)) {
          throw new StoreRefusal(
            'conflict',
            `the study "${checked.id}" is ${stored.simulated ? 'simulated' : 'of people'}: give this one another id`,
          );
        }
        if (stored?.plan === text) return infoOf(stored);
        if (stored) {
          const begun = database
            .prepare('SELECT 1 FROM participants WHERE study = ? AND (token_hash IS NOT NULL OR withdrawn = 1) LIMIT 1')
            .get(checked.id);
          const recorded = database.prepare('SELECT 1 FROM records WHERE study = ? LIMIT 1').get(checked.id);
          if (begun || recorded) {
            throw new StoreRefusal('conflict', `the study "${checked.id}" has begun: a changed plan needs another id`);
          }
          database.prepare('DELETE FROM participants WHERE study = ?').run(checked.id);
          database.prepare('DELETE FROM studies WHERE id = ?').run(checked.id);
        }
        database
          .prepare('INSERT INTO studies (id, plan, simulated, created_at, retention_until) VALUES (?, ?, ?, ?, ?)')
          .run(checked.id, text, Number(simulated), at, at + checked.retentionDays * secondsPerDay);
        const insert = database.prepare('INSERT INTO participants (study, participant, invitation) VALUES (?, ?, ?)');
        const common = checked.entry === 'open' ? newCode() : null;
        for (const participant of participantsOf(checked)) insert.run(checked.id, participant, common ?? newCode());
        return studyOf(checked.id);
      });
    },
    study: studyOf,
    studies: () => (sql.studies.all() as Record<string, unknown>[]).map(infoOf),
    invites(study, participant, code) {
      const { invitation } = participantOf(study, participant);
      // Hashes are of one length, as the comparison wants them.
      return invitation !== null && timingSafeEqual(hashOf(normalisedCode(code)), hashOf(invitation));
    },
    reinvite(study, participant) {
      const { plan } = studyOf(study);
      presentParticipant(study, participant);
      const whose = plan.entry === 'open' ? 'withdrawn = 0' : 'participant = ?';
      const of = plan.entry === 'open' ? [study] : [study, participant];
      database.prepare(`UPDATE participants SET invitation = ? WHERE study = ? AND ${whose}`).run(newCode(), ...of);
    },
    claim(study, participant, at) {
      const { retentionUntil } = studyOf(study);
      if (at > retentionUntil) throw new StoreRefusal('forbidden', `the study "${study}" is past its retention date`);
      return transaction(() => {
        const row = presentParticipant(study, participant);
        if (row.token_hash) {
          throw new StoreRefusal(
            'conflict',
            `${participant} is taken by another device: the experimenter can release it`,
          );
        }
        const token = newToken();
        const withdrawalCode = row.withdrawal_hash ? null : newCode();
        database
          .prepare(
            `UPDATE participants SET token_hash = ?, withdrawal_hash = coalesce(withdrawal_hash, ?)
             WHERE study = ? AND participant = ?`,
          )
          .run(hashOf(token), withdrawalCode && hashOf(withdrawalCode), study, participant);
        return { token, withdrawalCode };
      });
    },
    release(study, participant) {
      participantOf(study, participant);
      database
        .prepare('UPDATE participants SET token_hash = NULL WHERE study = ? AND participant = ?')
        .run(study, participant);
    },
    holds(study, participant, token) {
      const row = sql.participant.get(study, participant) as ParticipantRow | undefined;
      return row?.token_hash ? timingSafeEqual(row.token_hash, hashOf(token)) : false;
    },
    storeRecords(study, participant, records, at) {
      const { plan, simulated } = studyOf(study);
      return transaction(() => {
        let { motion_consent: consented } = presentParticipant(study, participant);
        for (const record of records) {
          if (record.study !== study || record.participant !== participant) {
            throw new StoreRefusal('forbidden', `"${record.id}" is of ${record.participant} in "${record.study}"`);
          }
          if (record.simulated !== simulated) {
            throw new StoreRefusal(
              'forbidden',
              `the study "${study}" is ${simulated ? 'simulated' : 'of people'}, "${record.id}" is not`,
            );
          }
          if (record.kind === 'consent') {
            if (record.body.version !== plan.consent.version) {
              throw new StoreRefusal(
                'conflict',
                `consent is to text ${record.body.version}, the study shows ${plan.consent.version}`,
              );
            }
            consented = Number(record.body.motion && plan.consent.motion !== null);
            database
              .prepare('UPDATE participants SET motion_consent = ? WHERE study = ? AND participant = ?')
              .run(consented, study, participant);
          }
          if (consented === null) {
            throw new StoreRefusal('forbidden', `${participant} has not consented: nothing is recorded`);
          }
          insertRecord(record, at);
        }
        return records.map(({ id }) => id);
      });
    },
    records: recordsOf,
    addRemark(study, participant, text, at) {
      const { simulated } = studyOf(study);
      return transaction(() => {
        if (presentParticipant(study, participant).motion_consent === null) {
          throw new StoreRefusal('forbidden', `${participant} has not consented: nothing is recorded`);
        }
        const { next } = database.prepare('SELECT coalesce(max(number), 0) + 1 AS next FROM records').get() as {
          next: number;
        };
        const id = `experimenter-${next}`;
        insertRecord(
          {
            version: recordVersion,
            id,
            study,
            participant,
            simulated,
            at,
            kind: 'event',
            body: { type: 'remark', text },
          },
          at,
        );
        return id;
      });
    },
    saveProgress(study, participant, progress, at) {
      const { plan, simulated } = studyOf(study);
      const checked = resumed(scheduleFor(plan, participant), JSON.stringify(progress));
      if (checked.simulated !== simulated) {
        throw new StoreRefusal(
          'forbidden',
          `the study "${study}" is ${simulated ? 'simulated' : 'of people'}, the session is not`,
        );
      }
      transaction(() => {
        presentParticipant(study, participant);
        database
          .prepare('UPDATE participants SET progress = ?, progress_at = ? WHERE study = ? AND participant = ?')
          .run(JSON.stringify(checked), at, study, participant);
      });
    },
    progress(study, participant) {
      const { progress } = participantOf(study, participant);
      return progress === null ? null : resumed(scheduleFor(studyOf(study).plan, participant), progress);
    },
    addCommand(study, participant, command, at) {
      return transaction(() => {
        presentParticipant(study, participant);
        const { count } = database
          .prepare('SELECT count(*) AS count FROM commands WHERE study = ? AND participant = ?')
          .get(study, participant) as { count: number };
        if (count >= mostCommandsPerParticipant) {
          throw new StoreRefusal('full', `${participant} was sent ${mostCommandsPerParticipant} commands already`);
        }
        const { number } = database
          .prepare('INSERT INTO commands (study, participant, command, at) VALUES (?, ?, ?, ?) RETURNING number')
          .get(study, participant, JSON.stringify(command), at) as { number: number };
        return number;
      });
    },
    commands(study, participant, after) {
      participantOf(study, participant);
      const rows = database
        .prepare(
          'SELECT number, at, command FROM commands WHERE study = ? AND participant = ? AND number > ? ORDER BY number',
        )
        .all(study, participant, after) as { number: number; at: number; command: string }[];
      return rows.map(({ number, at, command }) => ({ number, at, command: JSON.parse(command) as StudyCommand }));
    },
    storeMotion(study, participant, trial, text, at) {
      const gzipped = gzipSync(text);
      transaction(() => {
        if (presentParticipant(study, participant).motion_consent !== 1) {
          throw new StoreRefusal('forbidden', `${participant} has not consented to motion recording`);
        }
        const stored = database
          .prepare('SELECT gzipped FROM motion WHERE study = ? AND participant = ? AND trial = ?')
          .get(study, participant, trial) as { gzipped: Uint8Array } | undefined;
        if (stored) {
          if (gunzipSync(stored.gzipped).toString() === text) return;
          throw new StoreRefusal('conflict', `${participant} has stored another recording of "${trial}" already`);
        }
        const { bytes } = database
          .prepare('SELECT coalesce(sum(length(gzipped)), 0) AS bytes FROM motion WHERE study = ? AND participant = ?')
          .get(study, participant) as { bytes: number };
        if (bytes + gzipped.length > mostMotionPerParticipant) {
          throw new StoreRefusal('full', `${participant} has ${bytes} bytes of motion already`);
        }
        database
          .prepare('INSERT INTO motion (study, participant, trial, gzipped, received_at) VALUES (?, ?, ?, ?, ?)')
          .run(study, participant, trial, gzipped, at);
      });
    },
    motion(study, participant) {
      const rows =
        participant === undefined
          ? database.prepare('SELECT * FROM motion WHERE study = ? ORDER BY participant, trial').all(study)
          : database
              .prepare('SELECT * FROM motion WHERE study = ? AND participant = ? ORDER BY trial')
              .all(study, participant);
      return (rows as { participant: string; trial: string; gzipped: Uint8Array }[]).map((row) => ({
        participant: row.participant,
        trial: row.trial,
        text: gunzipSync(row.gzipped).toString(),
      }));
    },
    overview(study, now) {
      const { plan } = studyOf(study);
      const rows = database
        .prepare('SELECT * FROM participants WHERE study = ? ORDER BY participant')
        .all(study) as ParticipantRow[];
      return rows.map((row): ParticipantState => {
        const schedule = scheduleFor(plan, row.participant);
        const progress = row.progress === null ? null : resumed(schedule, row.progress);
        return {
          participant: row.participant,
          invitation: row.invitation,
          claimed: row.token_hash !== null,
          withdrawn: row.withdrawn === 1,
          records: countRecords(study, row.participant),
          session: progress && {
            step: progress.step,
            kind: currentStep(schedule, progress).kind,
            running: progress.running,
            paused: progress.paused,
            remainingSeconds: remainingSeconds(schedule, progress, now),
            reportedAt: row.progress_at as number,
          },
        };
      });
    },
    deleteParticipant,
    withdraw(study, code, at) {
      const row = database
        .prepare('SELECT participant FROM participants WHERE study = ? AND withdrawal_hash = ?')
        .get(study, hashOf(normalisedCode(code))) as { participant: string } | undefined;
      return row ? deleteParticipant(study, row.participant, 'withdrawn', at) : null;
    },
    deleteExpired(now) {
      const rows = database
        .prepare(
          `SELECT study, participant FROM participants JOIN studies ON studies.id = study
           WHERE retention_until < ? AND (token_hash IS NOT NULL OR withdrawal_hash IS NOT NULL OR progress IS NOT NULL)
           ORDER BY study, participant`,
        )
        .all(now) as { study: string; participant: string }[];
      return rows.map(({ study, participant }) => deleteParticipant(study, participant, 'retention', now));
    },
    receipts: (study) =>
      (
        database.prepare('SELECT * FROM receipts WHERE study = ? ORDER BY number').all(study) as Record<
          string,
          unknown
        >[]
      ).map(receiptOf),
    close: () => database.close(),
  };
}
