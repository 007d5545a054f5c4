import { closeSync, existsSync, fdatasync, openSync, type Stats, statSync } from 'node:fs';
import { stat } from 'node:fs/promises';
import { promisify } from 'node:util';
import { DatabaseSync, type DatabaseSyncInstance } from '@photostructure/sqlite';
import { reasonOf } from 'threepoint/core/errors/reasons';
import { GroupCommit } from 'threepoint-http/group-commit';
import { migrate } from './schema';

/** Why the store will not do it; the message is for the person who asked. */
export class StoreRefusal extends Error {
  /**
   * begun: a plan that has participants would change; it can become a new version. locked: another program writes to the database. busy: too
   * much is asked for at once. lost: the
   * database or its disk is not as the server left it, which a person must look into.
   */
  readonly reason: 'unknown' | 'conflict' | 'begun' | 'forbidden' | 'full' | 'locked' | 'busy' | 'lost';
  /** For the log: names what the person who asked has no business with, such as paths; null: the message says all. */
  readonly detail: string | null;

  constructor(reason: StoreRefusal['reason'], message: string, detail: string | null = null) {
    super(message);
    this.reason = reason;
    this.detail = detail;
  }
}

/** SQLite's extended codes: the disk, or what the database may take of it, is full; 4874: no room for the index of its log. */
const diskIsFull = new Set([13, 4874]);
/** SQLite's primary codes of a file that cannot be read or written as it should: READONLY, IOERR, CORRUPT, CANTOPEN, NOTADB. */
const fileIsBad = new Set([8, 10, 11, 14, 26]);

/** SQLite's extended code; null: the error is not SQLite's. */
export function sqliteCodeOf(error: unknown): number | null {
  const { sqliteExtendedCode } = (error ?? {}) as { sqliteExtendedCode?: unknown };
  return typeof sqliteExtendedCode === 'number' ? sqliteExtendedCode : null;
}

/** The refusal that SQLite's errors are to the person who asked; any other error as it is. */
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
  /** How far the file grows [bytes]. */
  readonly mostBytes: number;
  /** Opens an existing database that is up to date, and writes nothing. */
  readonly readOnly?: boolean;
}

/** How long opening waits for another program's lock [ms]. */
const openingMs = 5000;

/** Makes an empty file for the account of the server alone; SQLite gives the files beside it the same mode. */
function makeFile(file: string): void {
  if (!existsSync(file)) closeSync(openSync(file, 'a', 0o600));
}

const flushFile = promisify(fdatasync);

/** A file of the database as it was when it was opened. */
interface OpenedFile {
  readonly path: string;
  readonly identity: Pick<Stats, 'dev' | 'ino'>;
}

/**
 * The SQLite file of the studies. What a transaction wrote survives the end of the process at once, and a power cut once `flushed` has
 * resolved; what was deleted is overwritten. No call waits for another program's lock: it throws a StoreRefusal, and can be repeated.
 */
export class StudyDatabase {
  readonly #database: DatabaseSyncInstance;
  /** The database's file and its write-ahead log. */
  readonly #files: readonly OpenedFile[];
  /** Descriptor of the log, one for good, which reports every page that could not be written; null: the database is only read. */
  readonly #log: number | null;
  readonly #commits = new GroupCommit(() => this.#writeThrough());
  /** By their text: a statement is prepared once. */
  readonly #statements = new Map<string, Statement>();
  /** The log still holds deleted pages as they were. */
  #holdsDeleted = false;
  /** Why what is written is not where the next start looks for it; null: it is. */
  #misplaced: string | null = null;

  /** Opens the file, makes it where there is none, and brings it up to date. */
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

  /** All or nothing of what `body` writes; throws a StoreRefusal where the disk is full, the database locked or its file bad. */
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

  /** What `body` reads, all as of one moment. */
  snapshot<T>(body: () => T): T {
    this.#database.exec('BEGIN');
    try {
      return body();
    } finally {
      this.#database.exec('COMMIT');
    }
  }

  /** The first row, of which the caller knows the columns; undefined: there is none. */
  get<Row>(sql: string, ...parameters: readonly Parameter[]): Row | undefined {
    return this.#refusing(() => this.#statement(sql).get(...parameters) as Row | undefined);
  }

  /** The first row of a query that always has one. */
  getOne<Row>(sql: string, ...parameters: readonly Parameter[]): Row {
    return this.get<Row>(sql, ...parameters) as Row;
  }

  all<Row>(sql: string, ...parameters: readonly Parameter[]): readonly Row[] {
    return this.#refusing(() => this.#statement(sql).all(...parameters) as Row[]);
  }

  /** The rows one after the other: all of them might not fit into the memory. */
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

  /** Returns how many rows were changed. */
  run(sql: string, ...parameters: readonly Parameter[]): number {
    return this.#refusing(() => Number(this.#statement(sql).run(...parameters).changes));
  }

  /**
   * Resolves when everything written before this call survives a power cut. Rejects with a StoreRefusal where the disk failed, until the
   * server starts again, and where the files are not in their place any more.
   */
  async flushed(): Promise<void> {
    try {
      await this.#commits.flushed();
    } catch (error) {
      const text =
        'the disk of the server failed, and what was sent may not be stored: the server must be started again';
      throw new StoreRefusal('lost', text, reasonOf(error));
    }
    if (this.#misplaced !== null) {
      const text =
        'the folder of the studies was deleted or replaced while the server ran, and nothing is stored: it must be put back, or the server started again';
      throw new StoreRefusal('lost', text, this.#misplaced);
    }
  }

  /**
   * Empties the log, which still holds deleted pages as they were; flushes as it does. Returns false where another program reads the database
   * or the disk does not take it: what is committed stays in the log, and this must be tried again.
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

  /** Whether `forgetDeleted` is to be tried again. */
  get holdsDeleted(): boolean {
    return this.#holdsDeleted;
  }

  /** Moves what the log holds into the file, so that the file alone is a copy of everything. */
  close(): void {
    if (this.#log !== null) this.forgetDeleted();
    this.#database.close();
    if (this.#log !== null) closeSync(this.#log);
  }

  #prepare(mostBytes: number): void {
    // NORMAL: a transaction waits for no disk; `flushed` does, for many at once. SQLite itself flushes around its checkpoints, so that the
    // file stays sound at any moment. secure_delete: what was deleted is overwritten.
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
      // Within a transaction it is still to be rolled back, which needs the error as it is.
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

/** What happened to the file under its name; null: it is still the one that was opened. */
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

/** Another server has the folder. */
export class FolderTaken extends Error {}

/** A lock that a server holds on its folder for as long as it lives: SQLite's own, which ends with the process. */
export class FolderLock {
  readonly #database: DatabaseSyncInstance;

  /** Throws FolderTaken where another server holds it. */
  constructor(file: string) {
    makeFile(file);
    this.#database = new DatabaseSync(file);
    try {
      // Without a journal it takes no room on the disk.
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
