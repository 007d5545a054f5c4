import { randomBytes } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import type { IncomingMessage, ServerResponse } from 'node:http';
import { join } from 'node:path';
import { createStudyRoutes, shortestExperimenterToken } from './study-routes';
import { openStudyStore } from './study-store';

export interface StudyServiceOptions {
  /** Where the database and a token of our own making lie; made where it is missing. */
  readonly directory: string;
  /** The experimenter's token; null: the one kept in the directory, drawn at the first start. */
  readonly token: string | null;
  /** Seconds since 1970. */
  readonly now: () => number;
  /** Told of faults and of deletions by the retention date, one line each. */
  readonly log: (line: string) => void;
}

export interface StudyService {
  /** Answers requests below /api/studies and returns true; false for any other request. */
  handle(request: IncomingMessage, response: ServerResponse): boolean;
  /** Where the token lies; null: it was given. */
  readonly tokenFile: string | null;
  close(): void;
}

const hourMs = 3_600_000;

/** The token in this file; drawn and written, readable for its owner alone, where there is none. */
function keptToken(file: string): string {
  if (!existsSync(file)) writeFileSync(file, `${randomBytes(24).toString('base64url')}\n`, { mode: 0o600 });
  const token = readFileSync(file, 'utf8').trim();
  if (token.length < shortestExperimenterToken) {
    throw new Error(`${file}: the experimenter's token needs at least ${shortestExperimenterToken} characters`);
  }
  return token;
}

/** The studies of this server: its database, its routes and, once an hour, what its retention dates demand. */
export function openStudyService({ directory, token, now, log }: StudyServiceOptions): StudyService {
  mkdirSync(directory, { recursive: true, mode: 0o700 });
  const tokenFile = token === null ? join(directory, 'experimenter-token') : null;
  const experimenterToken = token ?? keptToken(tokenFile as string);
  const store = openStudyStore(join(directory, 'studies.db'));
  const handle = createStudyRoutes({
    store,
    experimenterToken,
    now,
    onFault: (error) => log(`study: ${error instanceof Error ? (error.stack ?? error.message) : String(error)}`),
  });
  const expire = () => {
    for (const { study, participant, records } of store.deleteExpired(now())) {
      log(`study "${study}": ${participant} is past the retention date, ${records} records deleted`);
    }
  };
  expire();
  const timer = setInterval(expire, hourMs);
  timer.unref();
  return {
    handle,
    tokenFile,
    close() {
      clearInterval(timer);
      store.close();
    },
  };
}
