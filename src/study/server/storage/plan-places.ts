import { togetherWith } from '../../model/plan/allocation';
import { participantsOf, type StudyPlan } from '../../model/plan/plan';
import type { StudyInfo } from '../../model/progress/study-api';
import { newCode } from './schema';
import type { StudyDatabase } from './study-database';

/** A place whose participant has begun, and the version of the plan that the participant follows. */
export interface BegunPlace {
  readonly participant: string;
  readonly plan_version: number;
}

/** The places that the versions of a plan have: which are taken, which are free, and their invitations. */
export class PlanPlaces {
  readonly #database: StudyDatabase;

  constructor(database: StudyDatabase) {
    this.#database = database;
  }

  /** Returns the places that are taken or have left records, in order of their codes. */
  begun(id: string): readonly BegunPlace[] {
    return this.#database.all(
      `SELECT participant, coalesce(plan_version, 1) AS plan_version FROM participants AS place
       WHERE study = ? AND (token_hash IS NOT NULL OR withdrawal_hash IS NOT NULL OR withdrawn = 1 OR EXISTS
         (SELECT 1 FROM records WHERE records.study = place.study AND records.participant = place.participant))
       ORDER BY participant`,
      id,
    );
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
   * Adds the places of a plan that do not exist yet, in a transaction; `linkOf` returns an earlier invitation of a
   * place, or null.
   */
  add(plan: StudyPlan, linkOf: (participant: string) => string | null): void {
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
  follow(id: string, versions: ReadonlyMap<string, number>): void {
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
  renewFree(
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
    this.add(plan, (participant) => (linksHold ? (links.get(participant) ?? common) : null));
  }

  /**
   * Moves a cleared place to the newest plan, in a transaction, with the places that follow an older version only
   * because of it. A place that the newest plan does not have is deleted. All stay if somebody who plays with them has
   * begun.
   */
  free({ plan, version, versions }: StudyInfo, participant: string): void {
    const { id } = plan;
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
    if (mixed || this.begun(id).some((begun) => freed.has(begun.participant))) return;
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
}
