import { type FileHandle, open } from 'node:fs/promises';
import { DatabaseSync, type DatabaseSyncInstance } from '@photostructure/sqlite';
import { SharedFlush } from './shared-flush';
import { migrate } from './study-schema';

/** Why the store will not do it; the message is for the person who asked. */
export class StoreRefusal extends Error {
  /** begun: a plan that has participants would change; it can become a new version. */
  readonly reason: 'unknown' | 'conflict' | 'begun' | 'forbidden' | 'full';

  constructor(reason: StoreRefusal['reason'], message: string) {
    super(message);
    this.reason = reason;
  }
}

/** SQLite's codes: the disk, or what the database may take of it, is full; 4874: no room for the index of its log. */
const diskIsFull = new Set([13, 4874]);

/** The refusal of what failed for want of room; any other error as it is. */
function asRefusal(error: unknown): unknown {
  const { sqliteExtendedCode } = (error ?? {}) as { sqliteExtendedCode?: unknown };
  return typeof sqliteExtendedCode === 'number' && diskIsFull.has(sqliteExtendedCode)
    ? new StoreRefusal('full', 'the disk of the server is full: nothing of this was stored')
    : error;
}

type Statement = ReturnType<DatabaseSyncInstance['prepare']>;
type Parameter = Parameters<Statement['run']>[number];

/**
 * The SQLite file of the studies. What a transaction wrote survives the end of the process at once, and a power cut once `flushed` has
 * resolved; what was deleted is overwritten.
 */
export class StudyDatabase {
  readonly #database: DatabaseSyncInstance;
  /** SQLite's write-ahead log, opened with the first flush; one handle for good hears of every page that could not be written. */
  #log: Promise<FileHandle> | null = null;
  readonly #flush: SharedFlush;
  /** By their text: a statement is prepared once. */
  readonly #statements = new Map<string, Statement>();

  /** Opens the file, makes it where there is none, and brings it up to date; it grows to `mostBytes`. */
  constructor(file: string, mostBytes: number) {
    this.#database = new DatabaseSync(file);
    this.#flush = new SharedFlush(async () => {
      this.#log ??= open(`${file}-wal`, 'r+');
      await (await this.#log).datasync();
    });
    // NORMAL: a transaction waits for no disk; `flushed` does, for many at once. SQLite itself flushes around its checkpoints, so that the
    // file stays sound at any moment. secure_delete: what was deleted is overwritten.
    this.#database.exec(`
      PRAGMA journal_mode = WAL;
      PRAGMA synchronous = NORMAL;
      PRAGMA foreign_keys = ON;
      PRAGMA secure_delete = ON;
      PRAGMA busy_timeout = 5000;
    `);
    const { page_size: pageBytes } = this.#database.prepare('PRAGMA page_size').get() as { page_size: number };
    this.#database.exec(`PRAGMA max_page_count = ${Math.floor(mostBytes / pageBytes)}`);
    migrate(this.#database);
  }

  /** All or nothing of what `body` writes; throws a StoreRefusal where the disk is full. */
  transaction<T>(body: () => T): T {
    try {
      this.#database.exec('BEGIN IMMEDIATE');
      const result = body();
      this.#database.exec('COMMIT');
      return result;
    } catch (error) {
      // A full disk has rolled back already.
      if (this.#database.isTransaction) this.#database.exec('ROLLBACK');
      throw asRefusal(error);
    }
  }

  /** The first row, of which the caller knows the columns; undefined: there is none. */
  get<Row>(sql: string, ...parameters: readonly Parameter[]): Row | undefined {
    return this.#statement(sql).get(...parameters) as Row | undefined;
  }

  /** The first row of a query that always has one. */
  getOne<Row>(sql: string, ...parameters: readonly Parameter[]): Row {
    return this.get<Row>(sql, ...parameters) as Row;
  }

  all<Row>(sql: string, ...parameters: readonly Parameter[]): readonly Row[] {
    return this.#statement(sql).all(...parameters) as Row[];
  }

  /** Returns how many rows were changed. */
  run(sql: string, ...parameters: readonly Parameter[]): number {
    return Number(this.#statement(sql).run(...parameters).changes);
  }

  /** Resolves when everything written before this call survives a power cut; rejects when the disk failed, until the server starts anew. */
  flushed(): Promise<void> {
    return this.#flush.flushed();
  }

  /** Empties the log, which still holds deleted pages as they were; flushes as it does. */
  forgetDeleted(): void {
    this.#database.exec('PRAGMA wal_checkpoint(TRUNCATE)');
  }

  /** Writes everything through to the disk. */
  close(): void {
    this.#database.close();
    void this.#log?.then((log) => log.close());
  }

  #statement(sql: string): Statement {
    const known = this.#statements.get(sql);
    if (known) return known;
    const statement = this.#database.prepare(sql);
    this.#statements.set(sql, statement);
    return statement;
  }
}
