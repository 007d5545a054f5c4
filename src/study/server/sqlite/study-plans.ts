import { ValidationError } from 'threepoint/core';
import { togetherWith } from '../../model/plan/allocation';
import { checkedPlan, participantsOf, type StudyPlan, storedPlan } from '../../model/plan/plan';
import { Rejection } from '../../model/progress/rejection';
import type { PlanVersion, StudyInfo } from '../../model/progress/study-api';
import { newCode } from '../codes';
import type { AddOptions, PlanStorage } from '../study-storage';
import type { StudyDatabase } from './study-database';

interface StudyRow {
  readonly id: string;
  readonly simulated: number;
  readonly created_at: number;
  readonly retention_until: number;
}

interface VersionRow {
  readonly version: number;
  readonly plan: string;
  readonly since: number;
}

/** A place whose participant has begun, and the version of the plan that the participant follows. */
interface BegunPlace {
  readonly participant: string;
  readonly plan_version: number;
}

const secondsPerDay = 86_400;

/** Returns "P01, P02 and 3 more". */
const listed = (names: readonly string[]) =>
  names.length > 4 ? `${names.slice(0, 3).join(', ')} and ${names.length - 3} more` : names.join(', ');

/** The studies: the versions of their plans and the places in these. */
export class StudyPlans implements PlanStorage {
  readonly #database: StudyDatabase;

  constructor(database: StudyDatabase) {
    this.#database = database;
  }

  get(id: string, version?: number): StudyInfo {
    const row = this.#row(id);
    if (!row) throw new Rejection('unknown', `there is no study "${id}"`);
    return this.#infoOf(row, version);
  }

  planFor(id: string, participant: string): StudyPlan {
    this.#rejectUnknown(id);
    const { plan } = this.#database.getOne<VersionRow>(
      `SELECT * FROM plan_versions WHERE study = ? AND version = coalesce(
         (SELECT plan_version FROM participants WHERE study = ? AND participant = ?),
         (SELECT max(version) FROM plan_versions WHERE study = ?))`,
      ...[id, id, participant, id],
    );
    return storedPlan(JSON.parse(plan));
  }

  all(): readonly StudyInfo[] {
    return this.#database
      .all<StudyRow>('SELECT * FROM studies ORDER BY created_at, id')
      .map((row) => this.#infoOf(row));
  }

  add(given: unknown, { simulated, at, newVersion = false }: AddOptions): StudyInfo {
    const plan = checkedPlan(given);
    return this.#database.transaction(() => {
      const stored = this.#row(plan.id);
      if (!stored) {
        this.#insert(plan, simulated, at);
        return this.get(plan.id);
      }
      if (stored.simulated !== Number(simulated)) {
        throw new Rejection(
          'conflict',
          `the study "${plan.id}" is ${stored.simulated ? 'simulated' : 'of people'}: give this one another id`,
        );
      }
      const known = this.#infoOf(stored);
      if (JSON.stringify(known.plan) === JSON.stringify(plan)) return known;
      const begun = this.#begun(plan.id);
      if (begun.length === 0) {
        this.remove(plan.id);
        this.#insert(plan, simulated, at);
      } else if (newVersion) this.#addVersion(known, plan, at);
      else {
        const text =
          `the study "${plan.id}" has begun: ${listed(begun.map(({ participant }) => participant))} keep its plan. ` +
          `Add the plan as version ${known.version + 1} for later participants, or give it another id`;
        throw new Rejection('begun', text, { field: 'newVersion' });
      }
      return this.get(plan.id);
    });
  }

  /** Deletes a study without records, in a transaction. */
  remove(id: string): void {
    for (const table of ['commands', 'participants', 'plan_versions']) {
      this.#database.run(`DELETE FROM ${table} WHERE study = ?`, id);
    }
    this.#database.run('DELETE FROM studies WHERE id = ?', id);
  }

  /** Returns the invitation that all places of an open study share in its newest plan, or null if there is none. */
  commonInvitation(id: string): string | null {
    const place = this.#database.get<{ invitation: string }>(
      `SELECT invitation FROM participants WHERE study = ? AND invitation IS NOT NULL AND (plan_version IS NULL OR plan_version =
         (SELECT max(version) FROM plan_versions WHERE plan_versions.study = participants.study)) LIMIT 1`,
      id,
    );
    return place?.invitation ?? null;
  }

  /**
   * Moves a cleared place to the newest plan, in a transaction, with the places that follow an older version only
   * because of it. A place that the newest plan does not have is deleted. All stay if a participant of one of these
   * places has begun.
   */
  free(id: string, participant: string): void {
    const { plan, version, versions } = this.get(id);
    const own = versions.find(({ participants }) => participants.includes(participant));
    if (!own || own.version === version) return;
    const freed = togetherWith(own.plan, participant);
    const keeps = new Set(
      versions.flatMap((older) =>
        older.version === version ? [] : older.participants.filter((one) => !freed.has(one)),
      ),
    );
    const inPlan = participantsOf(plan).filter((one) => freed.has(one));
    const mixed = inPlan.some((one) => [...togetherWith(plan, one)].some((other) => keeps.has(other)));
    if (mixed || this.#begun(id).some((begun) => freed.has(begun.participant))) return;
    for (const one of freed) {
      const place = [id, one] as const;
      if (inPlan.includes(one)) {
        this.#database.run('UPDATE participants SET plan_version = NULL WHERE study = ? AND participant = ?', ...place);
        continue;
      }
      for (const table of ['commands', 'participants']) {
        this.#database.run(`DELETE FROM ${table} WHERE study = ? AND participant = ?`, ...place);
      }
    }
  }

  #row(id: string): StudyRow | undefined {
    return this.#database.get<StudyRow>('SELECT * FROM studies WHERE id = ?', id);
  }

  #rejectUnknown(id: string): void {
    if (!this.#row(id)) throw new Rejection('unknown', `there is no study "${id}"`);
  }

  #infoOf(row: StudyRow, asked?: number): StudyInfo {
    const places = this.#database.all<{ participant: string; plan_version: number | null }>(
      'SELECT participant, plan_version FROM participants WHERE study = ? ORDER BY participant',
      row.id,
    );
    const versions = this.#database
      .all<VersionRow>('SELECT * FROM plan_versions WHERE study = ? ORDER BY version', row.id)
      .map(
        ({ version, plan, since }): PlanVersion => ({
          version,
          plan: storedPlan(JSON.parse(plan)),
          since,
          participants: places.filter((place) => place.plan_version === version).map(({ participant }) => participant),
        }),
      );
    const shown = asked === undefined ? versions.at(-1) : versions.find(({ version }) => version === asked);
    if (!shown) throw new Rejection('unknown', `the plan of "${row.id}" has no version ${asked}`);
    return {
      plan: shown.plan,
      version: shown.version,
      versions,
      simulated: row.simulated === 1,
      createdAt: row.created_at,
      retentionUntil: row.retention_until,
    };
  }

  #addVersion({ versions, version, plan: before, retentionUntil }: StudyInfo, plan: StudyPlan, at: number): void {
    const { id } = plan;
    const [text, textBefore] = [plan, before].map(({ consent }) => JSON.stringify({ ...consent, version: '' }));
    if (text !== textBefore && plan.consent.version === before.consent.version) {
      throw new ValidationError('consent.version', 'the text has changed, and its version has not');
    }
    const [code, codeBefore] = [plan, before].map((one) => participantsOf(one)[0]);
    if (code !== codeBefore) {
      throw new ValidationError(
        'participants',
        `the codes of participants would change from ${codeBefore} to ${code}, and sent links would stop working: give the plan another id`,
      );
    }
    const kept = new Map<string, number>();
    for (const { participant, plan_version } of this.#begun(id)) {
      const own = versions.find((one) => one.version === plan_version)?.plan ?? before;
      for (const member of togetherWith(own, participant)) kept.set(member, plan_version);
    }
    for (const participant of participantsOf(plan)) {
      const mixed = kept.has(participant)
        ? undefined
        : [...togetherWith(plan, participant)].find((one) => kept.has(one));
      if (mixed === undefined) continue;
      throw new Rejection(
        'conflict',
        `${participant} would play with ${mixed}, who stays with version ${kept.get(mixed)}: leave seed, participants and ` +
          'group sizes as they are, or give the plan another id',
      );
    }
    const common = plan.entry === 'open' ? this.commonInvitation(id) : null;
    this.#database.run(
      'INSERT INTO plan_versions (study, version, plan, since) VALUES (?, ?, ?, ?)',
      ...[id, version + 1, JSON.stringify(plan), at],
    );
    // The retention period that was promised to participants holds for all.
    const until = Math.min(retentionUntil, at + plan.retentionDays * secondsPerDay);
    this.#database.run('UPDATE studies SET retention_until = ? WHERE id = ?', until, id);
    this.#follow(id, kept);
    this.#renewFree(plan, { linksHold: plan.entry === before.entry, common });
  }

  #insert(plan: StudyPlan, simulated: boolean, at: number): void {
    const retentionUntil = at + plan.retentionDays * secondsPerDay;
    this.#database.run(
      'INSERT INTO studies (id, simulated, created_at, retention_until) VALUES (?, ?, ?, ?)',
      ...[plan.id, Number(simulated), at, retentionUntil],
    );
    this.#database.run(
      'INSERT INTO plan_versions (study, version, plan, since) VALUES (?, 1, ?, ?)',
      ...[plan.id, JSON.stringify(plan), at],
    );
    this.#addPlaces(plan, () => null);
  }

  /** Returns the places that are taken or have left records, in order of their codes. */
  #begun(id: string): readonly BegunPlace[] {
    return this.#database.all(
      `SELECT participant, coalesce(plan_version, 1) AS plan_version FROM participants AS place
       WHERE study = ? AND (token_hash IS NOT NULL OR withdrawal_hash IS NOT NULL OR withdrawn = 1 OR EXISTS
         (SELECT 1 FROM records WHERE records.study = place.study AND records.participant = place.participant))
       ORDER BY participant`,
      id,
    );
  }

  /**
   * Adds the places of a plan that do not exist yet, in a transaction; `linkOf` returns an earlier invitation of a
   * place, or null.
   */
  #addPlaces(plan: StudyPlan, linkOf: (participant: string) => string | null): void {
    const common = plan.entry === 'open' ? newCode() : null;
    for (const participant of participantsOf(plan)) {
      this.#database.run(
        `INSERT INTO participants (study, participant, invitation) VALUES (?, ?, ?)
         ON CONFLICT (study, participant) DO NOTHING`,
        ...[plan.id, participant, linkOf(participant) ?? common ?? newCode()],
      );
    }
  }

  /** Marks which version of a plan each place follows, in a transaction; a place without one follows the newest. */
  #follow(id: string, versions: ReadonlyMap<string, number>): void {
    this.#database.run('UPDATE participants SET plan_version = NULL WHERE study = ?', id);
    for (const [participant, version] of versions) {
      this.#database.run(
        'UPDATE participants SET plan_version = ? WHERE study = ? AND participant = ?',
        ...[version, id, participant],
      );
    }
  }

  /**
   * Replaces the free places by those of the new plan, in a transaction. If links stay valid, places keep theirs, and
   * new places get the common one; null: there is no common link.
   */
  #renewFree(
    plan: StudyPlan,
    { linksHold, common }: { readonly linksHold: boolean; readonly common: string | null },
  ): void {
    const { id } = plan;
    const free = this.#database.all<{ participant: string; invitation: string | null }>(
      'SELECT participant, invitation FROM participants WHERE study = ? AND plan_version IS NULL',
      id,
    );
    const links = new Map(free.map(({ participant, invitation }) => [participant, invitation]));
    this.#database.run('DELETE FROM participants WHERE study = ? AND plan_version IS NULL', id);
    this.#addPlaces(plan, (participant) => (linksHold ? (links.get(participant) ?? common) : null));
  }
}
