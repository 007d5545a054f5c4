import { randomBytes } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { reasonOf } from '../src/core/errors/reasons';
import type { WrongGuess } from './auth-throttle';
import { ConfigurationError } from './configuration';
import type { Service } from './http/router';
import { weaknessOf } from './secret-bits';
import type { Software } from './software';
import { createStudyRoutes } from './study-routes';
import type { StudySeats } from './study-seats';
import { openStudyStore } from './study-store';

export interface StudyServiceOptions {
  /** Where the database and a token of our own making lie; made where it is missing. */
  readonly directory: string;
  /** The experimenter's token; null: the one kept in the directory, drawn at the first start. */
  readonly token: string | null;
  /** What serves the studies now. */
  readonly software: Software;
  /** Seconds since 1970. */
  readonly now: () => number;
  /** Signs participants into the rooms of their trials. */
  readonly seats: StudySeats;
  /** Believe what a proxy in front says of a client's address. */
  readonly trustProxy: boolean;
  /** Told of faults, of wrong guesses and of deletions by the retention date, one line each. */
  readonly log: (line: string) => void;
}

export interface StudyService {
  readonly service: Service;
  /** Where the token lies; null: it was given. */
  readonly tokenFile: string | null;
  close(): void;
}

const hourMs = 3_600_000;

/** As this server draws tokens, and has drawn them before. */
const drawnToken = /^([\w-]{43}|[\w-]{32})$/;

/** The token in this file; drawn and written, readable for its owner alone, where there is none. */
function keptToken(file: string): string {
  if (!existsSync(file)) writeFileSync(file, `${randomBytes(32).toString('base64url')}\n`, { mode: 0o600 });
  const token = readFileSync(file, 'utf8').trim();
  const weakness = drawnToken.test(token) ? null : weaknessOf(token);
  if (weakness) throw new ConfigurationError(`The experimenter's token in ${file} ${weakness}`);
  return token;
}

const wrongGuess = ({ what, of, address, failures }: WrongGuess): string =>
  `study: a wrong ${what}${of === null ? '' : ` for "${of}"`} came from ${address}, number ${failures} within the hour`;

/** The studies of this server: its database, its routes and, once an hour, what its retention dates demand. */
export function openStudyService(options: StudyServiceOptions): StudyService {
  const { directory, token, software, now, seats, trustProxy, log } = options;
  mkdirSync(directory, { recursive: true, mode: 0o700 });
  const tokenFile = token === null ? join(directory, 'experimenter-token') : null;
  const experimenterToken = token ?? keptToken(tokenFile as string);
  const store = openStudyStore(join(directory, 'studies.db'));
  store.noteSoftware(software, now());
  const service = createStudyRoutes({
    store,
    software,
    experimenterToken,
    now,
    seats,
    trustProxy,
    onWrongGuess: (guess) => log(wrongGuess(guess)),
    onFault: (error) =>
      log(`study, a fault: ${error instanceof Error ? (error.stack ?? error.message) : String(error)}`),
  });
  const again = 'which is tried again within the hour';
  // A full disk or a locked database must not end a server that others use.
  const expire = () => {
    try {
      const receipts = store.deleteExpired(now(), ({ study, participant }, error) => {
        const failed = 'is past the retention date and could not be deleted';
        log(`study "${study}": ${participant} ${failed}, ${again}: ${reasonOf(error)}`);
      });
      for (const { study, participant, records } of receipts) {
        log(`study "${study}": ${participant} is past the retention date, ${records} records deleted`);
      }
    } catch (error) {
      log(`study: who is past a retention date could not be read, ${again}: ${reasonOf(error)}`);
    }
  };
  expire();
  const timer = setInterval(expire, hourMs);
  timer.unref();
  return {
    service,
    tokenFile,
    close() {
      clearInterval(timer);
      store.close();
    },
  };
}
