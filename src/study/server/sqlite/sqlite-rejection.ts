import { reasonOf } from 'threepoint/core';
import { Rejection } from '../../model/progress/rejection';

/** SQLite's primary code BUSY: another connection holds the lock. */
export const sqliteBusy = 5;
/** SQLite's extended codes for a full disk or database; 4874: no room for the index of its log. */
const diskIsFull = new Set([13, 4874]);
/** SQLite's primary codes for a file that cannot be read or written: READONLY, IOERR, CORRUPT, CANTOPEN, NOTADB. */
const fileIsBad = new Set([8, 10, 11, 14, 26]);

/** Returns SQLite's extended code, or null for other errors. */
export function sqliteCodeOf(error: unknown): number | null {
  const { sqliteExtendedCode } = (error ?? {}) as { sqliteExtendedCode?: unknown };
  return typeof sqliteExtendedCode === 'number' ? sqliteExtendedCode : null;
}

/** Returns the Rejection with the cause for an error of SQLite; other errors unchanged. */
export function rejectionOfSqlite(error: unknown): unknown {
  const code = sqliteCodeOf(error);
  if (code === null) return error;
  if (diskIsFull.has(code)) {
    return new Rejection('full', 'the disk of the server is full', { failure: 'not done' });
  }
  const primary = code & 0xff;
  if (primary === sqliteBusy) {
    return new Rejection('locked', 'another program holds the lock of the database', { failure: 'not done' });
  }
  if (!fileIsBad.has(primary)) return error;
  return new Rejection('lost', 'the database cannot be used', { detail: reasonOf(error), failure: 'not done' });
}
