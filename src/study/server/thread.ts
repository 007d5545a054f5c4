import { join } from 'node:path';
import type { MessagePort } from 'node:worker_threads';
import { reasonOf } from 'threepoint/core';
import { answerCalls, ConfigurationError, type FailedAttempt, type HttpResponse } from 'threepoint-http';
import { createExporter } from './export/exporter';
import { StudyDispatcher } from './routes/dispatcher';
import type { RouteHead, StudyRequest } from './routes/route';
import { createStudySeats, type SignSeat } from './routes/seats';
import { openStudyFolder, type StudyFolder, type StudyFolderOptions } from './sqlite/study-folder';
import type { StudyStore } from './sqlite/study-store';
import type { StudyStorage } from './study-storage';

// The thread of the studies has their database, their secrets and their access rules. Slow work and a hanging disk do
// not block the thread of the sockets.

export interface StudyThreadOptions extends StudyFolderOptions {
  /** The secret that signs participants into the rooms of their trials. */
  readonly secret: string;
}

export type OpenedStudies =
  | { readonly problem: string }
  | {
      readonly routes: readonly RouteHead[];
      /** The file with the generated token; null: the token was given. */
      readonly tokenFile: string | null;
    };

/** The calls of the thread; `at` is in seconds since 1970. */
export type StudyThreadApi = {
  /** Opens the studies, before any other call. */
  open(options: StudyThreadOptions, at: number): OpenedStudies;
  admit(request: StudyRequest): Promise<HttpResponse | undefined>;
  handle(request: StudyRequest, body: Uint8Array<ArrayBuffer>): Promise<HttpResponse>;
  /** Deletes what is past its retention date. */
  expire(at: number): Promise<void>;
  close(): void;
};

/** The interval at which failed overwriting of deleted data is repeated [ms]. */
const purgeMs = 1000;

const failedAttemptLine = ({ what, of, address, failures }: FailedAttempt): string =>
  `study: a wrong ${what}${of === null ? '' : ` for "${of}"`} came from ${address}, number ${failures} within the hour`;

type Log = (line: string) => void;

/** Deletes what is past its retention date. A full disk or a locked database must not end a server that others use. */
async function expire(store: StudyStorage, at: number, log: Log): Promise<void> {
  const again = 'which is tried again within the hour';
  try {
    const receipts = await store.deletion.deleteExpired(at, ({ study, participant }, error) => {
      const failed = 'is past the retention date and could not be deleted';
      log(`study "${study}": ${participant} ${failed}, ${again}: ${reasonOf(error)}`);
    });
    for (const { study, participant, records } of receipts) {
      log(`study "${study}": ${participant} is past the retention date, ${records} records deleted`);
    }
  } catch (error) {
    log(`study: the retention dates could not be read, ${again}: ${reasonOf(error)}`);
  }
}

/** Overwrites deleted data as soon as possible. */
function purgeRegularly(store: StudyStore, log: Log): NodeJS.Timeout {
  let isHeld = false;
  return setInterval(() => {
    const wasHeld = isHeld;
    isHeld = !store.purgeDeleted();
    if (isHeld && !wasHeld) {
      log(
        'study: deleted data stays in studies.db-wal while another program reads it or the disk is full: end that program, or make room',
      );
    }
    if (wasHeld && !isHeld) log('study: deleted data is overwritten now');
  }, purgeMs);
}

interface OpenFolder {
  readonly folder: StudyFolder;
  readonly dispatcher: StudyDispatcher;
  readonly forgetting: NodeJS.Timeout;
}

/** Makes the signer of seats from the secret of the server; `now` returns seconds since 1970. */
export type CreateSignSeat = (secret: string, now: () => number) => SignSeat;

/** Answers the calls on the port of this thread until the process ends. */
export function serveStudies(port: MessagePort, createSignSeat: CreateSignSeat): void {
  const log = (line: string) => port.postMessage(line);
  let serving: OpenFolder | null = null;
  // The time of the newest request, because the main thread has the clock of the process.
  let newest = 0;

  function open({ secret, ...options }: StudyThreadOptions, at: number): OpenedStudies {
    newest = at;
    try {
      const folder = openStudyFolder(options, at, log);
      const { store, experimenterToken, tokenFile } = folder;
      const { directory, software } = options;
      const dispatcher = new StudyDispatcher({
        ...{ store, experimenterToken, software, log },
        seats: createStudySeats(
          secret,
          createSignSeat(secret, () => newest),
        ),
        makeZip: createExporter(join(directory, 'studies.db')),
        onFailedAttempt: (guess) => log(failedAttemptLine(guess)),
      });
      serving = { folder, dispatcher, forgetting: purgeRegularly(store, log) };
      return { routes: dispatcher.routes.map(({ handle: _, ...rest }) => rest), tokenFile };
    } catch (error) {
      if (error instanceof ConfigurationError) return { problem: error.message };
      throw error;
    }
  }

  function opened(): OpenFolder {
    if (!serving) throw new Error('the studies are not open');
    return serving;
  }

  answerCalls<StudyThreadApi>(port, {
    open,
    admit(request) {
      newest = request.at;
      return opened().dispatcher.admit(request);
    },
    handle(request, body) {
      newest = request.at;
      return opened().dispatcher.handle(request, body);
    },
    expire: (at) => expire(opened().folder.store, at, log),
    close() {
      const { folder, forgetting } = opened();
      clearInterval(forgetting);
      folder.close();
      serving = null;
    },
  });
}
