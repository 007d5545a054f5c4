import { reasonOf } from 'threepoint/core';

/** An operation that the store refuses; the message is for the person who asked for it. */
export class StoreRefusal extends Error {
  /**
   * `begun`: participants have begun with the plan, hence it cannot change, but a new version can be added. `locked`:
   * another program writes to the database. `busy`: too many requests. `lost`: the database or its disk has failed or
   * was replaced, which a person must check.
   */
  readonly reason: 'unknown' | 'conflict' | 'begun' | 'forbidden' | 'full' | 'locked' | 'busy' | 'lost';
  /** Details for the log that the message must not show, such as paths; null: none. */
  readonly detail: string | null;

  constructor(reason: StoreRefusal['reason'], message: string, detail: string | null = null) {
    super(message);
    this.reason = reason;
    this.detail = detail;
  }
}

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

/** Returns the StoreRefusal for an error of SQLite; other errors unchanged. */
export function refusalOfSqlite(error: unknown): unknown {
  const code = sqliteCodeOf(error);
  if (code === null) return error;
  if (diskIsFull.has(code)) {
    return new StoreRefusal('full', 'the disk of the server is full: nothing was stored');
  }
  const primary = code & 0xff;
  if (primary === sqliteBusy) {
    return new StoreRefusal('locked', 'another program holds the lock of the database: nothing was stored');
  }
  if (!fileIsBad.has(primary)) return error;
  return new StoreRefusal('lost', 'the database cannot be used: nothing was stored', reasonOf(error));
}
