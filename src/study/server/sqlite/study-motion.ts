import { gunzipSync, gzipSync } from 'node:zlib';
import { Rejection } from '../../model/progress/rejection';
import type { MotionStorage, PackedMotion } from '../study-storage';
import type { StudyDatabase } from './study-database';
import type { StudyPlaces } from './study-places';

/** The limit of compressed recordings per participant [bytes]. */
export const maxMotionPerParticipant = 256 * 2 ** 20;

export class StudyMotion implements MotionStorage {
  readonly #database: StudyDatabase;
  readonly #places: StudyPlaces;

  constructor(database: StudyDatabase, places: StudyPlaces) {
    this.#database = database;
    this.#places = places;
  }

  store(study: string, participant: string, trial: string, text: string, at: number): void {
    const gzipped = gzipSync(text);
    this.#database.transaction(() => {
      if (this.#places.getPresent(study, participant).motion_consent !== 1) {
        throw new Rejection('forbidden', `${participant} has not consented to motion recording`);
      }
      const stored = this.#database.get<PackedMotion>(
        'SELECT gzipped FROM motion WHERE study = ? AND participant = ? AND trial = ?',
        ...[study, participant, trial],
      );
      if (stored) {
        if (gunzipSync(stored.gzipped).toString() === text) return;
        throw new Rejection('conflict', `${participant} has stored another recording of "${trial}" already`);
      }
      const { bytes } = this.#database.getOne<{ bytes: number }>(
        'SELECT coalesce(sum(length(gzipped)), 0) AS bytes FROM motion WHERE study = ? AND participant = ?',
        ...[study, participant],
      );
      if (bytes + gzipped.length > maxMotionPerParticipant) {
        throw new Rejection('full', `${participant} has ${bytes} bytes of motion already`);
      }
      this.#database.run(
        'INSERT INTO motion (study, participant, trial, gzipped, received_at) VALUES (?, ?, ?, ?, ?)',
        ...[study, participant, trial, gzipped, at],
      );
    });
  }

  all(study: string, participant?: string): readonly PackedMotion[] {
    const packed = 'SELECT participant, trial, gzipped FROM motion WHERE study = ?';
    return participant === undefined
      ? this.#database.all(`${packed} ORDER BY participant, trial`, study)
      : this.#database.all(`${packed} AND participant = ? ORDER BY trial`, study, participant);
  }

  /** Deletes the recordings of a participant, in a transaction; returns their number. */
  delete(study: string, participant: string): number {
    return this.#database.run('DELETE FROM motion WHERE study = ? AND participant = ?', study, participant);
  }
}
