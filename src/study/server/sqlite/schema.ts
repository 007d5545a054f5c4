import type { DatabaseSyncInstance } from '@photostructure/sqlite';

/**
 * Each migrates the database from its index to the next version. Never change a released one; add another one, and a
 * file of the new schema for the tests (tests/study/server/write-schema.ts).
 */
const migrations: readonly string[] = [
  `
  CREATE TABLE studies (
    id TEXT PRIMARY KEY,
    simulated INTEGER NOT NULL CHECK (simulated IN (0, 1)),
    created_at REAL NOT NULL,
    retention_until REAL NOT NULL
  ) STRICT;
  CREATE TABLE plan_versions (
    study TEXT NOT NULL REFERENCES studies (id),
    version INTEGER NOT NULL,
    plan TEXT NOT NULL,
    since REAL NOT NULL,
    PRIMARY KEY (study, version)
  ) STRICT;
  CREATE TABLE participants (
    study TEXT NOT NULL REFERENCES studies (id),
    participant TEXT NOT NULL,
    token_hash BLOB,
    withdrawal_hash BLOB,
    withdrawn INTEGER NOT NULL DEFAULT 0 CHECK (withdrawn IN (0, 1)),
    motion_consent INTEGER CHECK (motion_consent IN (0, 1)),
    progress TEXT,
    progress_at REAL,
    invitation TEXT,
    plan_version INTEGER,
    PRIMARY KEY (study, participant)
  ) STRICT;
  CREATE TABLE records (
    number INTEGER PRIMARY KEY,
    study TEXT NOT NULL,
    participant TEXT NOT NULL,
    id TEXT NOT NULL,
    record TEXT NOT NULL,
    received_at REAL NOT NULL,
    author TEXT NOT NULL CHECK (author IN ('participant', 'experimenter')),
    UNIQUE (study, participant, id),
    FOREIGN KEY (study, participant) REFERENCES participants (study, participant)
  ) STRICT;
  CREATE TABLE motion (
    study TEXT NOT NULL,
    participant TEXT NOT NULL,
    trial TEXT NOT NULL,
    gzipped BLOB NOT NULL,
    received_at REAL NOT NULL,
    PRIMARY KEY (study, participant, trial),
    FOREIGN KEY (study, participant) REFERENCES participants (study, participant)
  ) STRICT;
  CREATE TABLE commands (
    number INTEGER PRIMARY KEY AUTOINCREMENT,
    study TEXT NOT NULL,
    participant TEXT NOT NULL,
    command TEXT NOT NULL,
    at REAL NOT NULL,
    FOREIGN KEY (study, participant) REFERENCES participants (study, participant)
  ) STRICT;
  CREATE TABLE receipts (
    number INTEGER PRIMARY KEY AUTOINCREMENT,
    study TEXT NOT NULL,
    participant TEXT NOT NULL,
    reason TEXT NOT NULL,
    records INTEGER NOT NULL,
    motion_files INTEGER NOT NULL,
    at REAL NOT NULL
  ) STRICT;
  CREATE TABLE software (number INTEGER PRIMARY KEY, software TEXT NOT NULL, since REAL NOT NULL) STRICT;
  `,
];

/** Why a database cannot be used, as the end of a sentence that begins with its file. */
export class DatabaseProblem extends Error {}

/**
 * Migrates a database to the newest version; throws a DatabaseProblem if it is damaged, newer than this server, or of
 * another program.
 */
export function migrate(database: DatabaseSyncInstance): void {
  const read = (pragma: string) => Object.values(database.prepare(`PRAGMA ${pragma}`).get() as object)[0] as unknown;
  const version = read('user_version') as number;
  if (version > migrations.length) {
    throw new DatabaseProblem(
      `has version ${version}, and this server knows versions up to ${migrations.length}: install the version of the ` +
        'program that wrote it, or put an older copy of the file back.',
    );
  }
  const { tables } = database.prepare('SELECT count(*) AS tables FROM sqlite_master').get() as { tables: number };
  if (version === 0 && tables > 0) {
    throw new DatabaseProblem('is the database of another program: name another folder with --studies.');
  }
  const damage = read('quick_check(1)');
  if (damage !== 'ok') {
    throw new DatabaseProblem(
      `is damaged (${String(damage).replaceAll('\n', ' ')}): restore a copy, or recover the rest with ".recover" of sqlite3.`,
    );
  }
  for (let next = version; next < migrations.length; next++) {
    database.exec(`BEGIN IMMEDIATE; ${migrations[next]} PRAGMA user_version = ${next + 1}; COMMIT`);
  }
}
