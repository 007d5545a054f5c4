import type { DatabaseSyncInstance } from '@photostructure/sqlite';
import { newCode } from '../codes';

/**
 * Each migrates the database from its index to the next version. Never change a released one; add another one, and a
 * file of the new schema for the tests (tests/study/server/write-schema.ts).
 */
const migrations: readonly (string | ((database: DatabaseSyncInstance) => void))[] = [
  `
  CREATE TABLE studies (
    id TEXT PRIMARY KEY,
    plan TEXT NOT NULL,
    simulated INTEGER NOT NULL CHECK (simulated IN (0, 1)),
    created_at REAL NOT NULL,
    retention_until REAL NOT NULL
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
    PRIMARY KEY (study, participant)
  ) STRICT;
  CREATE TABLE records (
    number INTEGER PRIMARY KEY,
    study TEXT NOT NULL,
    participant TEXT NOT NULL,
    id TEXT NOT NULL,
    record TEXT NOT NULL,
    received_at REAL NOT NULL,
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
  `,
  // Earlier versions had places without invitations; each gets one.
  (database) => {
    database.exec('ALTER TABLE participants ADD COLUMN invitation TEXT');
    const places = database.prepare('SELECT study, participant FROM participants WHERE withdrawn = 0').all();
    const invite = database.prepare('UPDATE participants SET invitation = ? WHERE study = ? AND participant = ?');
    for (const { study, participant } of places as { study: string; participant: string }[]) {
      invite.run(newCode(), study, participant);
    }
  },
  `CREATE TABLE software (number INTEGER PRIMARY KEY, software TEXT NOT NULL, since REAL NOT NULL) STRICT;`,
  // Earlier versions had one plan per study, which becomes version 1 for all who have begun.
  `
  CREATE TABLE plan_versions (
    study TEXT NOT NULL REFERENCES studies (id),
    version INTEGER NOT NULL,
    plan TEXT NOT NULL,
    since REAL NOT NULL,
    PRIMARY KEY (study, version)
  ) STRICT;
  INSERT INTO plan_versions SELECT id, 1, plan, created_at FROM studies;
  ALTER TABLE studies DROP COLUMN plan;
  ALTER TABLE participants ADD COLUMN plan_version INTEGER;
  UPDATE participants SET plan_version = 1 WHERE token_hash IS NOT NULL OR withdrawal_hash IS NOT NULL OR withdrawn = 1
    OR EXISTS (SELECT 1 FROM records WHERE records.study = participants.study AND records.participant = participants.participant);
  `,
  // Earlier versions stored only of the experimenter's remarks with whose token they came.
  `
  ALTER TABLE records ADD COLUMN author TEXT CHECK (author IN ('participant', 'experimenter'));
  UPDATE records SET author = 'experimenter' WHERE id LIKE 'experimenter-%';
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
    const migration = migrations[next] as (typeof migrations)[number];
    database.exec('BEGIN IMMEDIATE');
    if (typeof migration === 'string') database.exec(migration);
    else migration(database);
    database.exec(`PRAGMA user_version = ${next + 1}; COMMIT`);
  }
}
