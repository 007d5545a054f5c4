import type { Software } from 'threepoint-http';
import type { ServedSoftware, SoftwareStorage } from '../study-storage';
import type { StudyDatabase } from './study-database';

export class StudySoftware implements SoftwareStorage {
  readonly #database: StudyDatabase;

  constructor(database: StudyDatabase) {
    this.#database = database;
  }

  note(software: Software, at: number): void {
    const text = JSON.stringify(software);
    const last = this.#database.get<{ software: string }>('SELECT software FROM software ORDER BY number DESC LIMIT 1');
    if (last?.software === text) return;
    this.#database.transaction(() => {
      this.#database.run('INSERT INTO software (software, since) VALUES (?, ?)', text, at);
    });
  }

  since(at: number): readonly ServedSoftware[] {
    const all = this.#database
      .all<{ software: string; since: number }>('SELECT software, since FROM software ORDER BY number')
      .map(({ software, since }) => ({ since, ...(JSON.parse(software) as Software) }));
    return all.filter((_, index) => (all[index + 1]?.since ?? Number.POSITIVE_INFINITY) > at);
  }
}
