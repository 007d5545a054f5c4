import { randomBytes } from 'node:crypto';
import { chmodSync, existsSync, mkdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { DatabaseSync, type DatabaseSyncInstance } from '@photostructure/sqlite';
import { reasonOf } from 'threepoint/core';
import { ConfigurationError, type Software, secretWeakness } from 'threepoint-http';
import { Rejection } from '../../model/progress/rejection';
import { DatabaseProblem } from './schema';
import { sqliteBusy, sqliteCodeOf } from './sqlite-rejection';
import { createPrivateFile } from './study-database';
import { openStudyStore, type StudyStore } from './study-store';

/** The open folder of the studies, which no other server uses. */
export interface StudyFolder {
  readonly store: StudyStore;
  readonly experimenterToken: string;
  /** The file with the generated token; null: the token was given. */
  readonly tokenFile: string | null;
  close(): void;
}

const modeOf = (path: string): string => (statSync(path).mode & 0o777).toString(8).padStart(4, '0');

/** Returns the token in this file, which is generated and written with access for its owner only if it is missing. */
function readOrCreateToken(file: string): string {
  if (!existsSync(file)) writeFileSync(file, `${randomBytes(32).toString('base64url')}\n`, { mode: 0o600 });
  const token = readFileSync(file, 'utf8').trim();
  const weakness = secretWeakness(token);
  if (weakness) throw new ConfigurationError(`The experimenter's token in ${file} ${weakness}`);
  return token;
}

/** Removes the access of other accounts of the machine. Windows has no such modes. */
function restrictAccess(path: string, mode: number, log: (line: string) => void): void {
  if (process.platform === 'win32' || !existsSync(path) || (statSync(path).mode & 0o077) === 0) return;
  const before = `${path} was open to other accounts of this machine (mode ${modeOf(path)})`;
  try {
    chmodSync(path, mode);
    log(`study: ${before}; its mode is ${modeOf(path)} now.`);
  } catch (error) {
    log(`study: ${before}, which could not be changed (${reasonOf(error)}): run "chmod ${mode.toString(8)} ${path}".`);
  }
}

/** Creates the folder and its files with access for the server's account only. */
function prepare(directory: string, log: (line: string) => void): void {
  mkdirSync(directory, { recursive: true, mode: 0o700 });
  restrictAccess(directory, 0o700, log);
  for (const name of ['studies.db', 'studies.db-wal', 'studies.db-shm', 'studies.lock', 'experimenter-token']) {
    restrictAccess(join(directory, name), 0o600, log);
  }
}

/**
 * Locks the folder until the lock is closed or the process ends: it is an exclusive transaction of SQLite. Throws a
 * ConfigurationError if another server holds it.
 */
function lockFolder(directory: string): DatabaseSyncInstance {
  const file = join(directory, 'studies.lock');
  createPrivateFile(file);
  const lock = new DatabaseSync(file);
  try {
    // Without a journal the lock needs no room on the disk.
    lock.exec('PRAGMA journal_mode = MEMORY; BEGIN EXCLUSIVE');
    return lock;
  } catch (error) {
    lock.close();
    if (((sqliteCodeOf(error) ?? 0) & 0xff) !== sqliteBusy) throw error;
    throw new ConfigurationError(
      `Another server uses the folder ${directory}. Stop it, or name another folder with --studies.`,
    );
  }
}

/** Returns how to repair a folder that cannot be opened, or null for unrelated errors. */
function remedyOf(error: unknown, directory: string): string | null {
  const file = join(directory, 'studies.db');
  const reason = reasonOf(error);
  if (error instanceof DatabaseProblem) return `${file} ${error.message}`;
  if (error instanceof Rejection)
    return `${file} cannot be written: ${reason}. Repair that, then start the server again.`;
  const { code = '' } = (error ?? {}) as NodeJS.ErrnoException;
  const sqlite = (sqliteCodeOf(error) ?? 0) & 0xff;
  if (code === 'EMFILE' || code === 'ENFILE') {
    return `The server may not open enough files (${reason}). Raise the limit: ulimit -n 1024.`;
  }
  if (code === 'ENOSPC' || code === 'EDQUOT' || sqlite === 13) {
    return `The disk with ${directory} is full (${reason}). Make room, then start the server again.`;
  }
  if (sqlite === 5 || sqlite === 6) {
    return `${file} is locked by another program (${reason}). End that program, then start the server again.`;
  }
  if (sqlite === 11 || sqlite === 26) {
    return `${file} is damaged or not a database (${reason}). Restore a copy, or move it away to start with an empty one; "sqlite3 ${file} .recover" reads what can still be read.`;
  }
  if (sqlite === 0 && !/^E[A-Z]+$/.test(code)) return null;
  const what = sqlite === 0 ? `The folder ${directory}` : file;
  return `${what} cannot be used (${reason}). Give the account of the server the right to write there, or name another folder with --studies.`;
}

export interface StudyFolderOptions {
  /** The folder of the database and of a generated token; created if it is missing. */
  readonly directory: string;
  /** The experimenter's token; null: the one in the folder, which is generated at the first start. */
  readonly token: string | null;
  /** The software that serves the studies from now on. */
  readonly software: Software;
}

/**
 * Opens the folder of the studies at this time [s]. Throws a ConfigurationError with the file and the remedy if another
 * server uses it, if it is not writable, or if the database is damaged, locked or of a newer version.
 */
export function openStudyFolder(
  { directory, token, software }: StudyFolderOptions,
  at: number,
  log: (line: string) => void,
): StudyFolder {
  const opened: { close(): void }[] = [];
  const close = () => {
    for (const part of opened.toReversed()) part.close();
  };
  try {
    prepare(directory, log);
    opened.push(lockFolder(directory));
    const tokenFile = token === null ? join(directory, 'experimenter-token') : null;
    const experimenterToken = token ?? readOrCreateToken(tokenFile as string);
    const store = openStudyStore(join(directory, 'studies.db'));
    opened.push(store);
    store.software.note(software, at);
    return { store, experimenterToken, tokenFile, close };
  } catch (error) {
    close();
    if (error instanceof ConfigurationError) throw error;
    const remedy = remedyOf(error, directory);
    throw remedy === null ? error : new ConfigurationError(remedy);
  }
}
