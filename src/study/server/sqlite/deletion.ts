import { Rejection } from '../../model/progress/rejection';
import type { Receipt } from '../../model/progress/study-api';
import { newCode } from '../codes';
import type { DeletionError, DeletionStorage } from '../study-storage';
import type { StudyCommands } from './study-commands';
import type { StudyDatabase } from './study-database';
import type { StudyMotion } from './study-motion';
import type { StudyPlaces } from './study-places';
import type { StudyPlans } from './study-plans';
import type { StudyRecords } from './study-records';

/** The columns of a receipt. */
const receiptColumns = 'number, study, participant, reason, records, motion_files AS motionFiles, at';

export interface StudyDeletionParts {
  readonly database: StudyDatabase;
  readonly plans: StudyPlans;
  readonly places: StudyPlaces;
  readonly records: StudyRecords;
  readonly motion: StudyMotion;
  readonly commands: StudyCommands;
}

export class StudyDeletion implements DeletionStorage {
  readonly #parts: StudyDeletionParts;

  constructor(parts: StudyDeletionParts) {
    this.#parts = parts;
  }

  delete(study: string, participant: string, reason: Receipt['reason'], at: number): Receipt {
    const { database, plans, places, records, motion, commands } = this.#parts;
    const receipt = database.transaction(() => {
      // Refuses an unknown participant.
      places.get(study, participant);
      const invitation = this.#invitationAfter(study, reason);
      const recordCount = records.delete(study, participant);
      const motionFiles = motion.delete(study, participant);
      commands.delete(study, participant);
      places.clear(study, participant, invitation, reason === 'withdrawn');
      if (reason === 'experimenter') plans.free(study, participant);
      return this.#addReceipt({ study, participant, reason, records: recordCount, motionFiles, at });
    });
    database.purgeDeleted();
    return receipt;
  }

  withdrawMotion(study: string, code: string, at: number): Receipt | null {
    const { database, places, records, motion, commands } = this.#parts;
    const participant = places.ownerOf(study, code);
    if (participant === null) return null;
    const hadConsent = places.getPresent(study, participant).motion_consent === 1;
    const receipt = database.transaction(() => {
      const motionFiles = motion.delete(study, participant);
      if (hadConsent) {
        places.setMotionConsent(study, participant, 0);
        records.addMotionWithdrawal(study, participant, at);
      }
      return this.#addReceipt({ study, participant, reason: 'withdrawn', records: 0, motionFiles, at });
    });
    if (hadConsent) commands.add(study, participant, { type: 'withdraw-motion' }, at);
    database.purgeDeleted();
    return receipt;
  }

  deleteSimulated(study: string): void {
    const { database, plans } = this.#parts;
    if (!plans.get(study).simulated) {
      throw new Rejection('forbidden', `the study "${study}" has data of people: delete its participants one by one`);
    }
    database.transaction(() => {
      for (const table of ['records', 'motion', 'receipts']) {
        database.run(`DELETE FROM ${table} WHERE study = ?`, study);
      }
      plans.remove(study);
    });
    database.purgeDeleted();
  }

  withdraw(study: string, code: string, at: number): Receipt | null {
    const participant = this.#parts.places.ownerOf(study, code);
    return participant === null ? null : this.delete(study, participant, 'withdrawn', at);
  }

  deleteExpired(now: number, onError: DeletionError): readonly Receipt[] {
    return this.#parts.places.expired(now).flatMap((place) => {
      try {
        return [this.delete(place.study, place.participant, 'retention', now)];
      } catch (error) {
        onError(place, error);
        return [];
      }
    });
  }

  receipts(study: string): readonly Receipt[] {
    return this.#parts.database.all(`SELECT ${receiptColumns} FROM receipts WHERE study = ? ORDER BY number`, study);
  }

  /** Stores a receipt, in a transaction. */
  #addReceipt({ study, participant, reason, records, motionFiles, at }: Omit<Receipt, 'number'>): Receipt {
    return this.#parts.database.getOne<Receipt>(
      `INSERT INTO receipts (study, participant, reason, records, motion_files, at) VALUES (?, ?, ?, ?, ?, ?)
       RETURNING ${receiptColumns}`,
      ...[study, participant, reason, records, motionFiles, at],
    );
  }

  /**
   * A participant who withdrew stays out. A place that the experimenter cleared can be taken by a new invitation or by
   * the common one.
   */
  #invitationAfter(study: string, reason: Receipt['reason']): string | null {
    const { plans } = this.#parts;
    if (reason !== 'experimenter') return null;
    const common = plans.get(study).plan.entry === 'open' ? plans.commonInvitation(study) : null;
    return common ?? newCode();
  }
}
