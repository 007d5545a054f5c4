import { checkedPlan, participantsOf, type StudyPlan } from '../src/core/study/plan';
import type { StudyInfo } from '../src/core/study/study-api';
import { StoreRefusal, type StudyDatabase } from './study-database';
import { newCode } from './study-schema';

interface StudyRow {
  readonly id: string;
  readonly plan: string;
  readonly simulated: number;
  readonly created_at: number;
  readonly retention_until: number;
}

const secondsPerDay = 86_400;

const infoOf = (row: StudyRow): StudyInfo => ({
  plan: checkedPlan(JSON.parse(row.plan)),
  simulated: row.simulated === 1,
  createdAt: row.created_at,
  retentionUntil: row.retention_until,
});

/** The studies themselves: their plans, and the places that these have. */
export class StudyPlans {
  readonly #database: StudyDatabase;

  constructor(database: StudyDatabase) {
    this.#database = database;
  }

  /** The study of this id; throws a StoreRefusal where there is none. */
  get(id: string): StudyInfo {
    const row = this.#row(id);
    if (!row) throw new StoreRefusal('unknown', `there is no study "${id}"`);
    return infoOf(row);
  }

  /** Oldest first. */
  all(): readonly StudyInfo[] {
    return this.#database.all<StudyRow>('SELECT * FROM studies ORDER BY created_at, id').map(infoOf);
  }

  /** Adds a study, or finds the same one there; refuses another plan under the id of a study that has begun. */
  add(plan: StudyPlan, simulated: boolean, at: number): StudyInfo {
    return this.#database.transaction(() => {
      const checked = checkedPlan(plan);
      const stored = this.#row(checked.id);
      if (stored && stored.simulated !== Number(simulated)) {
        throw new StoreRefusal(
          'conflict',
          `the study "${checked.id}" is ${stored.simulated ? 'simulated' : 'of people'}: give this one another id`,
        );
      }
      if (stored?.plan === JSON.stringify(checked)) return infoOf(stored);
      if (stored) this.#removeUnbegun(checked.id);
      this.#insert(checked, simulated, at);
      return this.get(checked.id);
    });
  }

  #row(id: string): StudyRow | undefined {
    return this.#database.get<StudyRow>('SELECT * FROM studies WHERE id = ?', id);
  }

  #removeUnbegun(id: string): void {
    const begun = this.#database.get(
      'SELECT 1 FROM participants WHERE study = ? AND (token_hash IS NOT NULL OR withdrawn = 1) LIMIT 1',
      id,
    );
    const recorded = this.#database.get('SELECT 1 FROM records WHERE study = ? LIMIT 1', id);
    if (begun || recorded) {
      throw new StoreRefusal('conflict', `the study "${id}" has begun: a changed plan needs another id`);
    }
    this.#database.run('DELETE FROM participants WHERE study = ?', id);
    this.#database.run('DELETE FROM studies WHERE id = ?', id);
  }

  #insert(plan: StudyPlan, simulated: boolean, at: number): void {
    const retentionUntil = at + plan.retentionDays * secondsPerDay;
    this.#database.run(
      'INSERT INTO studies (id, plan, simulated, created_at, retention_until) VALUES (?, ?, ?, ?, ?)',
      ...[plan.id, JSON.stringify(plan), Number(simulated), at, retentionUntil],
    );
    const common = plan.entry === 'open' ? newCode() : null;
    for (const participant of participantsOf(plan)) {
      this.#database.run(
        'INSERT INTO participants (study, participant, invitation) VALUES (?, ?, ?)',
        ...[plan.id, participant, common ?? newCode()],
      );
    }
  }
}
