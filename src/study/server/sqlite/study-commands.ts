import { Rejection } from '../../model/progress/rejection';
import type { NumberedCommand, StudyCommand } from '../../model/progress/study-api';
import type { CommandStorage } from '../study-storage';
import type { StudyDatabase } from './study-database';
import type { StudyPlaces } from './study-places';

export const maxCommandsPerParticipant = 10_000;

export class StudyCommands implements CommandStorage {
  readonly #database: StudyDatabase;
  readonly #places: StudyPlaces;

  constructor(database: StudyDatabase, places: StudyPlaces) {
    this.#database = database;
    this.#places = places;
  }

  add(study: string, participant: string, command: StudyCommand, at: number): number {
    return this.#database.transaction(() => {
      this.#places.getPresent(study, participant);
      const { count } = this.#database.getOne<{ count: number }>(
        'SELECT count(*) AS count FROM commands WHERE study = ? AND participant = ?',
        ...[study, participant],
      );
      if (count >= maxCommandsPerParticipant) {
        throw new Rejection('full', `${participant} was sent ${maxCommandsPerParticipant} commands already`);
      }
      const { number } = this.#database.getOne<{ number: number }>(
        'INSERT INTO commands (study, participant, command, at) VALUES (?, ?, ?, ?) RETURNING number',
        ...[study, participant, JSON.stringify(command), at],
      );
      return number;
    });
  }

  after(study: string, participant: string, number: number): readonly NumberedCommand[] {
    this.#places.get(study, participant);
    const rows = this.#database.all<{ number: number; at: number; command: string }>(
      'SELECT number, at, command FROM commands WHERE study = ? AND participant = ? AND number > ? ORDER BY number',
      ...[study, participant, number],
    );
    return rows.map((row) => ({ number: row.number, at: row.at, command: JSON.parse(row.command) as StudyCommand }));
  }

  /** Deletes the commands of a participant, in a transaction. */
  delete(study: string, participant: string): void {
    this.#database.run('DELETE FROM commands WHERE study = ? AND participant = ?', study, participant);
  }
}
