import { DatabaseSync, type DatabaseSyncInstance } from '@photostructure/sqlite';
import { createPrivateFile } from './private-file';
import { sqliteBusy, sqliteCodeOf } from './sqlite-errors';

/** Thrown when another server uses the folder. */
export class FolderInUse extends Error {}

/**
 * A lock that a server holds on its folder while it runs. It is an exclusive transaction of SQLite, which ends with the
 * process.
 */
export class FolderLock {
  readonly #database: DatabaseSyncInstance;

  /** Throws FolderInUse if another server holds it. */
  constructor(file: string) {
    createPrivateFile(file);
    this.#database = new DatabaseSync(file);
    try {
      // Without a journal the lock needs no room on the disk.
      this.#database.exec('PRAGMA journal_mode = MEMORY; BEGIN EXCLUSIVE');
    } catch (error) {
      this.#database.close();
      if (((sqliteCodeOf(error) ?? 0) & 0xff) !== sqliteBusy) throw error;
      throw new FolderInUse();
    }
  }

  close(): void {
    this.#database.close();
  }
}
