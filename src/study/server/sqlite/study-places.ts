import { createHash, randomBytes, timingSafeEqual } from 'node:crypto';
import { scheduleFor } from '../../model/plan/schedule';
import { isLater, type Progress, resumed, sinceReport } from '../../model/progress/progress';
import { Rejection } from '../../model/progress/rejection';
import { newCode, normalisedCode } from '../codes';
import type { PlaceStorage } from '../study-storage';
import type { StudyDatabase } from './study-database';
import type { StudyPlans } from './study-plans';

/** A stored place. */
export interface PlaceRow {
  readonly participant: string;
  readonly token_hash: Uint8Array | null;
  readonly withdrawal_hash: Uint8Array | null;
  readonly invitation: string | null;
  readonly withdrawn: number;
  /** The version of the plan that the participant follows; null: the newest. */
  readonly plan_version: number | null;
  readonly motion_consent: number | null;
  readonly progress: string | null;
  readonly progress_at: number | null;
}

export const notConsented = (participant: string): Rejection =>
  new Rejection('forbidden', `${participant} has not consented: nothing is recorded`);

const hashOf = (secret: string): Buffer => createHash('sha256').update(secret).digest();
const newToken = (): string => randomBytes(32).toString('base64url');

/** The places of a study's participants: invitations, tokens, withdrawal codes and progress. */
export class StudyPlaces implements PlaceStorage {
  readonly #database: StudyDatabase;
  readonly #plans: StudyPlans;

  constructor(database: StudyDatabase, plans: StudyPlans) {
    this.#database = database;
    this.#plans = plans;
  }

  get(study: string, participant: string): PlaceRow {
    const row = this.#row(study, participant);
    if (!row) throw new Rejection('unknown', `the study "${study}" has no participant ${participant}`);
    return row;
  }

  /** Returns the place of a participant; throws a Rejection for an unknown one and for one who has withdrawn. */
  getPresent(study: string, participant: string): PlaceRow {
    const row = this.get(study, participant);
    if (row.withdrawn) throw new Rejection('forbidden', `${participant} has withdrawn`);
    return row;
  }

  all(study: string): readonly PlaceRow[] {
    return this.#database.all('SELECT * FROM participants WHERE study = ? ORDER BY participant', study);
  }

  acceptsInvitation(study: string, participant: string, code: string): boolean {
    const { invitation } = this.get(study, participant);
    // Hashes have equal lengths, which the comparison requires.
    return invitation !== null && timingSafeEqual(hashOf(normalisedCode(code)), hashOf(invitation));
  }

  renewInvitation(study: string, participant: string): void {
    const isOpen = this.#plans.get(study).plan.entry === 'open';
    this.getPresent(study, participant);
    const code = newCode();
    if (isOpen) {
      this.#database.run('UPDATE participants SET invitation = ? WHERE study = ? AND withdrawn = 0', code, study);
      return;
    }
    this.#database.run(
      'UPDATE participants SET invitation = ? WHERE study = ? AND participant = ?',
      ...[code, study, participant],
    );
  }

  claim(
    study: string,
    participant: string,
    at: number,
  ): { readonly token: string; readonly withdrawalCode: string | null } {
    const { retentionUntil } = this.#plans.get(study);
    if (at > retentionUntil) throw new Rejection('forbidden', `the study "${study}" is past its retention date`);
    return this.#database.transaction(() => {
      const row = this.getPresent(study, participant);
      if (row.token_hash) {
        throw new Rejection(
          'conflict',
          `${participant} is taken by another device: go on there, or ask for the place to be released`,
        );
      }
      const token = newToken();
      const withdrawalCode = row.withdrawal_hash ? null : newCode();
      this.#database.run(
        `UPDATE participants SET token_hash = ?, withdrawal_hash = coalesce(withdrawal_hash, ?),
         plan_version = coalesce(plan_version, (SELECT max(version) FROM plan_versions WHERE plan_versions.study = participants.study))
         WHERE study = ? AND participant = ?`,
        ...[hashOf(token), withdrawalCode && hashOf(withdrawalCode), study, participant],
      );
      return { token, withdrawalCode };
    });
  }

  release(study: string, participant: string): void {
    this.get(study, participant);
    this.#database.run(
      `UPDATE participants SET token_hash = NULL,
       withdrawal_hash = CASE WHEN progress IS NULL AND motion_consent IS NULL THEN NULL ELSE withdrawal_hash END
       WHERE study = ? AND participant = ?`,
      ...[study, participant],
    );
  }

  holds(study: string, participant: string, token: string): boolean {
    const row = this.#row(study, participant);
    return row?.token_hash ? timingSafeEqual(row.token_hash, hashOf(token)) : false;
  }

  /** Returns the participant with this withdrawal code, or null. */
  ownerOf(study: string, withdrawalCode: string): string | null {
    const row = this.#database.get<PlaceRow>(
      'SELECT participant FROM participants WHERE study = ? AND withdrawal_hash = ?',
      ...[study, hashOf(normalisedCode(withdrawalCode))],
    );
    return row?.participant ?? null;
  }

  /** Sets the consent to motion, in a transaction. */
  setMotionConsent(study: string, participant: string, consent: number): void {
    this.#database.run(
      'UPDATE participants SET motion_consent = ? WHERE study = ? AND participant = ?',
      ...[consent, study, participant],
    );
  }

  saveProgress(study: string, participant: string, progress: unknown, at: number): void {
    const { simulated } = this.#plans.get(study);
    const schedule = scheduleFor(this.#plans.planFor(study, participant), participant);
    const checked = resumed(schedule, JSON.stringify(progress));
    if (checked.simulated !== simulated) {
      throw new Rejection(
        'forbidden',
        `the study "${study}" is ${simulated ? 'simulated' : 'of people'}, the session is not`,
      );
    }
    this.#database.transaction(() => {
      const { motion_consent, progress: stored } = this.getPresent(study, participant);
      if (motion_consent === null) throw notConsented(participant);
      // On another device a participant may withdraw the recorded consent to motion.
      if (checked.motion === false && motion_consent === 1) this.setMotionConsent(study, participant, 0);
      if (stored !== null && isLater(schedule, resumed(schedule, stored), checked)) return;
      this.#database.run(
        'UPDATE participants SET progress = ?, progress_at = ? WHERE study = ? AND participant = ?',
        ...[JSON.stringify(checked), at, study, participant],
      );
    });
  }

  progress(study: string, participant: string, now?: number): Progress | null {
    const { progress, progress_at } = this.get(study, participant);
    if (progress === null) return null;
    const report = resumed(scheduleFor(this.#plans.planFor(study, participant), participant), progress);
    return now === undefined ? report : sinceReport(report, now - (progress_at as number));
  }

  /** Clears a place, in a transaction. `withdrawn`: the participant stays out. */
  clear(study: string, participant: string, invitation: string | null, withdrawn: boolean): void {
    this.#database.run(
      `UPDATE participants SET token_hash = NULL, withdrawal_hash = NULL, motion_consent = NULL, progress = NULL,
       progress_at = NULL, withdrawn = ?, invitation = ? WHERE study = ? AND participant = ?`,
      ...[Number(withdrawn), invitation, study, participant],
    );
  }

  /** Returns the places of studies past their retention date that still hold data. */
  expired(now: number): readonly { readonly study: string; readonly participant: string }[] {
    return this.#database.all(
      `SELECT study, participant FROM participants JOIN studies ON studies.id = study
       WHERE retention_until < ? AND (token_hash IS NOT NULL OR withdrawal_hash IS NOT NULL OR progress IS NOT NULL)
       ORDER BY study, participant`,
      now,
    );
  }

  #row(study: string, participant: string): PlaceRow | undefined {
    return this.#database.get('SELECT * FROM participants WHERE study = ? AND participant = ?', study, participant);
  }
}
