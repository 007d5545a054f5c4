import { closeSync, existsSync, fdatasync, openSync, type Stats, statSync } from 'node:fs';
import { stat } from 'node:fs/promises';
import { promisify } from 'node:util';
import { DatabaseSync, type DatabaseSyncInstance } from '@photostructure/sqlite';
import { reasonOf } from 'threepoint/core';
import { GroupCommit } from 'threepoint-http';
import { Rejection } from '../../model/progress/rejection';
import { migrate } from './schema';
import { rejectionOfSqlite } from './sqlite-rejection';

type Statement = ReturnType<DatabaseSyncInstance['prepare']>;
type Parameter = Parameters<Statement['run']>[number];

export interface DatabaseOptions {
  /** The largest size of the file [bytes]. */
  readonly maxBytes: number;
  /** Opens an existing database that is up to date, and writes nothing. */
  readonly readOnly?: boolean;
}

/** How long opening waits for the lock of another program [ms]. */
const openingMs = 5000;

const flushFile = promisify(fdatasync);

/**
 * Creates an empty file that only the server's account can read, unless it exists. SQLite gives the files next to it
 * the same mode.
 */
export function createPrivateFile(file: string): void {
  if (!existsSync(file)) closeSync(openSync(file, 'a', 0o600));
}

/** A file of the database and its identity when it was opened. */
interface OpenedFile {
  readonly path: string;
  readonly identity: Pick<Stats, 'dev' | 'ino'>;
}

/**
 * The SQLite file of the studies. A committed transaction survives a crash of the process; it survives a power cut once
 * `flushed` has resolved. Deleted data are overwritten. No call waits for the lock of another program: it throws a
 * Rejection and can be repeated.
 */
export class StudyDatabase {
  readonly #database: DatabaseSyncInstance;
  /** The database's file and its write-ahead log. */
  readonly #files: readonly OpenedFile[];
  /**
   * A permanent descriptor of the write-ahead log, which reports every page that could not be written; null: the
   * database is only read.
   */
  readonly #walDescriptor: number | null;
  readonly #commits = new GroupCommit(() => this.#writeThrough());
  /** Prepared statements by their text. */
  readonly #statements = new Map<string, Statement>();
  /** Whether the write-ahead log still holds deleted pages. */
  #mustPurge = false;
  /** Which file was moved or deleted since the database was opened, and how; null: none. */
  #misplaced: string | null = null;

  /** Opens the file, creates it if it is missing, and brings it up to date. */
  constructor(file: string, { maxBytes, readOnly = false }: DatabaseOptions) {
    if (!readOnly) createPrivateFile(file);
    this.#database = new DatabaseSync(file, { readOnly });
    this.#database.exec(`PRAGMA busy_timeout = ${openingMs}`);
    try {
      if (!readOnly) this.#prepare(maxBytes);
    } catch (error) {
      this.#database.close();
      throw error;
    }
    this.#database.exec('PRAGMA busy_timeout = 0');
    this.#walDescriptor = readOnly ? null : openSync(`${file}-wal`, 'r+');
    this.#files = [file, `${file}-wal`].map((path) => ({ path, identity: statSync(path) }));
  }

  /**
   * Runs `body` in a transaction; throws a Rejection if the disk is full, the database locked or its file unusable.
   */
  transaction<T>(body: () => T): T {
    try {
      this.#database.exec('BEGIN IMMEDIATE');
      const result = body();
      this.#database.exec('COMMIT');
      return result;
    } catch (error) {
      // SQLite has already rolled back on a full disk.
      if (this.#database.isTransaction) this.#database.exec('ROLLBACK');
      throw rejectionOfSqlite(error);
    }
  }

  /** Runs `body`, whose reads all see one state of the database. */
  snapshot<T>(body: () => T): T {
    this.#database.exec('BEGIN');
    try {
      return body();
    } finally {
      this.#database.exec('COMMIT');
    }
  }

  /** Returns the first row, whose columns the caller knows, or undefined. */
  get<Row>(sql: string, ...parameters: readonly Parameter[]): Row | undefined {
    return this.#translateErrors(() => this.#statement(sql).get(...parameters) as Row | undefined);
  }

  /** Returns the first row of a query that always has one. */
  getOne<Row>(sql: string, ...parameters: readonly Parameter[]): Row {
    return this.get<Row>(sql, ...parameters) as Row;
  }

  all<Row>(sql: string, ...parameters: readonly Parameter[]): readonly Row[] {
    return this.#translateErrors(() => this.#statement(sql).all(...parameters) as Row[]);
  }

  /** Yields the rows one after the other, because all of them might not fit into memory. */
  *each<Row>(sql: string, ...parameters: readonly Parameter[]): Iterable<Row> {
    const rows = this.#translateErrors(() =>
      this.#statement(sql)
        .iterate(...parameters)
        [Symbol.iterator](),
    );
    for (;;) {
      const { done, value } = this.#translateErrors(() => rows.next());
      if (done) return;
      yield value as Row;
    }
  }

  /** Returns the number of changed rows. */
  run(sql: string, ...parameters: readonly Parameter[]): number {
    return this.#translateErrors(() => Number(this.#statement(sql).run(...parameters).changes));
  }

  /**
   * Resolves when everything written before this call survives a power cut. Rejects with a Rejection after a failure
   * of the disk, until the server starts again, and if the files were moved or deleted.
   */
  async flushed(): Promise<void> {
    try {
      await this.#commits.flush();
    } catch (error) {
      const text = 'the disk of the server failed, and the server must be restarted';
      throw new Rejection('lost', text, { detail: reasonOf(error), failure: 'unknown' });
    }
    if (this.#misplaced !== null) {
      const text = 'the folder of the studies was deleted or replaced. Put it back, or restart the server';
      throw new Rejection('lost', text, { detail: this.#misplaced });
    }
  }

  /**
   * Empties the write-ahead log, which still holds deleted pages, and flushes. Returns false if another program reads
   * the database or the disk fails: committed data stay in that log, and the call must be repeated.
   */
  purgeDeleted(): boolean {
    this.#mustPurge = true;
    try {
      const [row] = this.all<{ busy: number }>('PRAGMA wal_checkpoint(TRUNCATE)');
      this.#mustPurge = row?.busy !== 0;
    } catch (error) {
      if (!(error instanceof Rejection)) throw error;
    }
    return !this.#mustPurge;
  }

  /** Whether deleted pages are left, hence `purgeDeleted` must be called again. */
  get mustPurge(): boolean {
    return this.#mustPurge;
  }

  /** Moves the write-ahead log into the file, so that the file alone is a complete copy. */
  close(): void {
    if (this.#walDescriptor !== null) this.purgeDeleted();
    this.#database.close();
    if (this.#walDescriptor !== null) closeSync(this.#walDescriptor);
  }

  #prepare(maxBytes: number): void {
    // NORMAL: transactions do not wait for the disk; `flushed` does, for many at once. SQLite flushes around its
    // checkpoints, so that the file is always sound. secure_delete: deleted data are overwritten.
    this.#database.exec(`
      PRAGMA journal_mode = WAL;
      PRAGMA synchronous = NORMAL;
      PRAGMA foreign_keys = ON;
      PRAGMA secure_delete = ON;
      PRAGMA temp_store = MEMORY;
    `);
    const { page_size: pageBytes } = this.#database.prepare('PRAGMA page_size').get() as { page_size: number };
    this.#database.exec(`PRAGMA max_page_count = ${Math.floor(maxBytes / pageBytes)}`);
    migrate(this.#database);
  }

  async #writeThrough(): Promise<void> {
    if (this.#walDescriptor !== null) await flushFile(this.#walDescriptor);
    const [problem] = (await Promise.all(this.#files.map(displacementOf))).filter((found) => found !== null);
    this.#misplaced = problem ?? null;
  }

  #translateErrors<T>(body: () => T): T {
    try {
      return body();
    } catch (error) {
      // In a transaction the caller rolls back, which needs the original error.
      throw this.#database.isTransaction ? error : rejectionOfSqlite(error);
    }
  }

  #statement(sql: string): Statement {
    const known = this.#statements.get(sql);
    if (known) return known;
    const statement = this.#database.prepare(sql);
    this.#statements.set(sql, statement);
    return statement;
  }
}

/** Resolves with a sentence if the path no longer leads to the file that was opened; else null. */
async function displacementOf({ path, identity }: OpenedFile): Promise<string | null> {
  try {
    const { dev, ino } = await stat(path);
    return dev === identity.dev && ino === identity.ino ? null : `${path} was replaced`;
  } catch (error) {
    const { code } = error as NodeJS.ErrnoException;
    return code === 'ENOENT' || code === 'ENOTDIR'
      ? `${path} was deleted`
      : `${path} could not be reached (${reasonOf(error)})`;
  }
}
