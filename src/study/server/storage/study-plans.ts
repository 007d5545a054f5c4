import { ValidationError } from 'threepoint/core/validation/validation';
import { togetherWith } from '../../model/plan/allocation';
import { checkedPlan, participantsOf, type StudyPlan, storedPlan } from '../../model/plan/plan';
import type { PlanVersion, StudyInfo } from '../../model/progress/study-api';
import type { PlanPlaces } from './plan-places';
import { StoreRefusal } from './store-refusal';
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

export interface AddOptions {
  readonly simulated: boolean;
  /** Seconds since 1970. */
  readonly at: number;
  /** Whether another plan becomes a new version for later participants if the study has begun. */
  readonly newVersion?: boolean;
}

const secondsPerDay = 86_400;

/** Returns "P01, P02 and 3 more". */
const listed = (names: readonly string[]) =>
  names.length > 4 ? `${names.slice(0, 3).join(', ')} and ${names.length - 3} more` : names.join(', ');

/** The studies: the versions of their plans and the places in these. */
export class StudyPlans {
  readonly #database: StudyDatabase;
  readonly #places: PlanPlaces;

  constructor(database: StudyDatabase, places: PlanPlaces) {
    this.#database = database;
    this.#places = places;
  }

  /** Returns a study with this version of its plan or with the newest; throws a StoreRefusal if it is unknown. */
  get(id: string, version?: number): StudyInfo {
    const row = this.#row(id);
    if (!row) throw new StoreRefusal('unknown', `there is no study "${id}"`);
    return this.#infoOf(row, version);
  }

  /** Returns the plan that a participant follows: that of their beginning, or the newest. */
  planFor(id: string, participant: string): StudyPlan {
    this.#refuseUnknown(id);
    const { plan } = this.#database.getOne<VersionRow>(
      `SELECT * FROM plan_versions WHERE study = ? AND version = coalesce(
         (SELECT plan_version FROM participants WHERE study = ? AND participant = ?),
         (SELECT max(version) FROM plan_versions WHERE study = ?))`,
      ...[id, id, participant, id],
    );
    return storedPlan(JSON.parse(plan));
  }

  /** Returns all studies, the oldest first. */
  all(): readonly StudyInfo[] {
    return this.#database
      .all<StudyRow>('SELECT * FROM studies ORDER BY created_at, id')
      .map((row) => this.#infoOf(row));
  }

  /**
   * Adds a study, or returns an equal one that exists. Another plan for a study that has begun is refused unless it is
   * added as a new version. Participants who have begun, and those who play with them, keep their version. Throws a
   * ValidationError for an invalid plan.
   */
  add(given: unknown, { simulated, at, newVersion = false }: AddOptions): StudyInfo {
    const plan = checkedPlan(given);
    return this.#database.transaction(() => {
      const stored = this.#row(plan.id);
      if (!stored) {
        this.#insert(plan, simulated, at);
        return this.get(plan.id);
      }
      if (stored.simulated !== Number(simulated)) {
        throw new StoreRefusal(
          'conflict',
          `the study "${plan.id}" is ${stored.simulated ? 'simulated' : 'of people'}: give this one another id`,
        );
      }
      const known = this.#infoOf(stored);
      if (JSON.stringify(known.plan) === JSON.stringify(plan)) return known;
      const begun = this.#places.begun(plan.id);
      if (begun.length === 0) {
        this.remove(plan.id);
        this.#insert(plan, simulated, at);
      } else if (newVersion) this.#addVersion(known, plan, at);
      else {
        const text =
          `the study "${plan.id}" has begun: ${listed(begun.map(({ participant }) => participant))} keep its plan. ` +
          `Add the plan as version ${known.version + 1} for later participants, or give it another id`;
        throw new StoreRefusal('begun', text);
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

  #row(id: string): StudyRow | undefined {
    return this.#database.get<StudyRow>('SELECT * FROM studies WHERE id = ?', id);
  }

  #refuseUnknown(id: string): void {
    if (!this.#row(id)) throw new StoreRefusal('unknown', `there is no study "${id}"`);
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
    if (!shown) throw new StoreRefusal('unknown', `the plan of "${row.id}" has no version ${asked}`);
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
    for (const { participant, plan_version } of this.#places.begun(id)) {
      const own = versions.find((one) => one.version === plan_version)?.plan ?? before;
      for (const member of togetherWith(own, participant)) kept.set(member, plan_version);
    }
    for (const participant of participantsOf(plan)) {
      const mixed = kept.has(participant)
        ? undefined
        : [...togetherWith(plan, participant)].find((one) => kept.has(one));
      if (mixed === undefined) continue;
      throw new StoreRefusal(
        'conflict',
        `${participant} would play with ${mixed}, who stays with version ${kept.get(mixed)}: leave seed, participants and ` +
          'group sizes as they are, or give the plan another id',
      );
    }
    const common = plan.entry === 'open' ? this.#places.commonInvitation(id) : null;
    this.#database.run(
      'INSERT INTO plan_versions (study, version, plan, since) VALUES (?, ?, ?, ?)',
      ...[id, version + 1, JSON.stringify(plan), at],
    );
    // The retention period that was promised to participants holds for all.
    const until = Math.min(retentionUntil, at + plan.retentionDays * secondsPerDay);
    this.#database.run('UPDATE studies SET retention_until = ? WHERE id = ?', until, id);
    this.#places.follow(id, kept);
    this.#places.renewFree(plan, { linksHold: plan.entry === before.entry, common });
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
    this.#places.add(plan, () => null);
  }
}
