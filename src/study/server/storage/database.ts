import { closeSync, existsSync, fdatasync, openSync, type Stats, statSync } from 'node:fs';
import { stat } from 'node:fs/promises';
import { promisify } from 'node:util';
import { DatabaseSync, type DatabaseSyncInstance } from '@photostructure/sqlite';
import { reasonOf } from 'threepoint/core/errors/reasons';
import { GroupCommit } from 'threepoint-http/group-commit';
import { migrate } from './schema';

/** An operation that the store refuses; the message is for the person who asked for it. */
export class StoreRefusal extends Error {
  /**
   * begun: the plan of participants who have begun would change; it can become a new version. locked: another program
   * writes to the database. busy: too many requests. lost: the database or its disk is not as the server left it, which
   * a person must check.
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

/** SQLite's extended codes for a full disk or database; 4874: no room for the index of its log. */
const diskIsFull = new Set([13, 4874]);
/** SQLite's primary codes for a file that cannot be read or written: READONLY, IOERR, CORRUPT, CANTOPEN, NOTADB. */
const fileIsBad = new Set([8, 10, 11, 14, 26]);

/** Returns SQLite's extended code, or null for other errors. */
export function sqliteCodeOf(error: unknown): number | null {
  const { sqliteExtendedCode } = (error ?? {}) as { sqliteExtendedCode?: unknown };
  return typeof sqliteExtendedCode === 'number' ? sqliteExtendedCode : null;
}

/** Returns the refusal for an error of SQLite, and other errors unchanged. */
function asRefusal(error: unknown): unknown {
  const code = sqliteCodeOf(error);
  if (code === null) return error;
  if (diskIsFull.has(code)) {
    return new StoreRefusal('full', 'the disk of the server is full: nothing of this was stored');
  }
  const primary = code & 0xff;
  if (primary === 5) {
    return new StoreRefusal('locked', 'another program holds the lock of the database: nothing of this was stored');
  }
  if (!fileIsBad.has(primary)) return error;
  return new StoreRefusal('lost', 'the database cannot be used: nothing of this was stored', reasonOf(error));
}

type Statement = ReturnType<DatabaseSyncInstance['prepare']>;
type Parameter = Parameters<Statement['run']>[number];

export interface DatabaseOptions {
  /** The largest size of the file [bytes]. */
  readonly mostBytes: number;
  /** Opens an existing database that is up to date, and writes nothing. */
  readonly readOnly?: boolean;
}

/** How long opening waits for the lock of another program [ms]. */
const openingMs = 5000;

/** Makes an empty file that only the server's account can read; SQLite gives the files next to it the same mode. */
function makeFile(file: string): void {
  if (!existsSync(file)) closeSync(openSync(file, 'a', 0o600));
}

const flushFile = promisify(fdatasync);

/** A file of the database and its identity when it was opened. */
interface OpenedFile {
  readonly path: string;
  readonly identity: Pick<Stats, 'dev' | 'ino'>;
}

/**
 * The SQLite file of the studies. A transaction survives the end of the process at once, and a power cut once `flushed`
 * has resolved; deleted data are overwritten. No call waits for the lock of another program: it throws a StoreRefusal
 * and can be repeated.
 */
export class StudyDatabase {
  readonly #database: DatabaseSyncInstance;
  /** The database's file and its write-ahead log. */
  readonly #files: readonly OpenedFile[];
  /**
   * A permanent descriptor of the log, which reports every page that could not be written; null: the database is only
   * read.
   */
  readonly #log: number | null;
  readonly #commits = new GroupCommit(() => this.#writeThrough());
  /** Prepared statements by their text. */
  readonly #statements = new Map<string, Statement>();
  /** Whether the log still holds deleted pages. */
  #holdsDeleted = false;
  /** Why the data are not where the next start looks for them; null: they are. */
  #misplaced: string | null = null;

  /** Opens the file, creates it if it is missing, and brings it up to date. */
  constructor(file: string, { mostBytes, readOnly = false }: DatabaseOptions) {
    if (!readOnly) makeFile(file);
    this.#database = new DatabaseSync(file, { readOnly });
    this.#database.exec(`PRAGMA busy_timeout = ${openingMs}`);
    try {
      if (!readOnly) this.#prepare(mostBytes);
    } catch (error) {
      this.#database.close();
      throw error;
    }
    this.#database.exec('PRAGMA busy_timeout = 0');
    this.#log = readOnly ? null : openSync(`${file}-wal`, 'r+');
    this.#files = [file, `${file}-wal`].map((path) => ({ path, identity: statSync(path) }));
  }

  /**
   * Runs `body` in a transaction; throws a StoreRefusal if the disk is full, the database locked or its file unusable.
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
      throw asRefusal(error);
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
    return this.#refusing(() => this.#statement(sql).get(...parameters) as Row | undefined);
  }

  /** Returns the first row of a query that always has one. */
  getOne<Row>(sql: string, ...parameters: readonly Parameter[]): Row {
    return this.get<Row>(sql, ...parameters) as Row;
  }

  all<Row>(sql: string, ...parameters: readonly Parameter[]): readonly Row[] {
    return this.#refusing(() => this.#statement(sql).all(...parameters) as Row[]);
  }

  /** Yields the rows one after the other, because all of them might not fit into memory. */
  *each<Row>(sql: string, ...parameters: readonly Parameter[]): Iterable<Row> {
    const rows = this.#refusing(() =>
      this.#statement(sql)
        .iterate(...parameters)
        [Symbol.iterator](),
    );
    for (;;) {
      const { done, value } = this.#refusing(() => rows.next());
      if (done) return;
      yield value as Row;
    }
  }

  /** Returns the number of changed rows. */
  run(sql: string, ...parameters: readonly Parameter[]): number {
    return this.#refusing(() => Number(this.#statement(sql).run(...parameters).changes));
  }

  /**
   * Resolves when everything written before this call survives a power cut. Rejects with a StoreRefusal after a failure
   * of the disk, until the server starts again, and if the files were moved or deleted.
   */
  async flushed(): Promise<void> {
    try {
      await this.#commits.flush();
    } catch (error) {
      const text = 'the disk of the server failed, and this may not be stored. Restart the server';
      throw new StoreRefusal('lost', text, reasonOf(error));
    }
    if (this.#misplaced !== null) {
      const text =
        'the folder of the studies was deleted or replaced while the server ran, and nothing is stored. Put it back, or restart the server';
      throw new StoreRefusal('lost', text, this.#misplaced);
    }
  }

  /**
   * Empties the log, which still holds deleted pages, and flushes. Returns false if another program reads the database
   * or the disk fails: committed data stay in the log, and the call must be repeated.
   */
  forgetDeleted(): boolean {
    this.#holdsDeleted = true;
    try {
      const [row] = this.all<{ busy: number }>('PRAGMA wal_checkpoint(TRUNCATE)');
      this.#holdsDeleted = row?.busy !== 0;
    } catch (error) {
      if (!(error instanceof StoreRefusal)) throw error;
    }
    return !this.#holdsDeleted;
  }

  /** Whether `forgetDeleted` must be called again. */
  get holdsDeleted(): boolean {
    return this.#holdsDeleted;
  }

  /** Moves the log into the file, so that the file alone is a complete copy. */
  close(): void {
    if (this.#log !== null) this.forgetDeleted();
    this.#database.close();
    if (this.#log !== null) closeSync(this.#log);
  }

  #prepare(mostBytes: number): void {
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
    this.#database.exec(`PRAGMA max_page_count = ${Math.floor(mostBytes / pageBytes)}`);
    migrate(this.#database);
  }

  async #writeThrough(): Promise<void> {
    if (this.#log !== null) await flushFile(this.#log);
    const [problem] = (await Promise.all(this.#files.map(displacementOf))).filter((found) => found !== null);
    this.#misplaced = problem ?? null;
  }

  #refusing<T>(body: () => T): T {
    try {
      return body();
    } catch (error) {
      // In a transaction the caller rolls back, which needs the original error.
      throw this.#database.isTransaction ? error : asRefusal(error);
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

/** Resolves with what happened to the file under its name, or with null if it is still the one that was opened. */
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

/** Another server uses the folder. */
export class FolderTaken extends Error {}

/** A lock that a server holds on its folder while it runs: a lock of SQLite, which ends with the process. */
export class FolderLock {
  readonly #database: DatabaseSyncInstance;

  /** Throws FolderTaken if another server holds it. */
  constructor(file: string) {
    makeFile(file);
    this.#database = new DatabaseSync(file);
    try {
      // Without a journal the lock needs no room on the disk.
      this.#database.exec('PRAGMA journal_mode = MEMORY; BEGIN EXCLUSIVE');
    } catch (error) {
      this.#database.close();
      if (((sqliteCodeOf(error) ?? 0) & 0xff) !== 5) throw error;
      throw new FolderTaken();
    }
  }

  close(): void {
    this.#database.close();
  }
}
