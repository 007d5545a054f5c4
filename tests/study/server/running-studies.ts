import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { createRouter, type FailedAttempt, GroupCommit, noPage } from 'threepoint-http';
import { RoomTokens } from 'threepoint-relay';
import { expect, onTestFinished } from 'vitest';
import type { StudyPlan } from '../../../src/study/model/plan/plan';
import { createExporter } from '../../../src/study/server/export/exporter';
import { StudyDispatcher } from '../../../src/study/server/routes/dispatcher';
import { createStudySeats } from '../../../src/study/server/routes/seats';
import { createStudyService, openStudyService } from '../../../src/study/server/service';
import { openStudyStore, type StudyStore } from '../../../src/study/server/sqlite/study-store';
import { serve } from '../../http/serve';
import { isNightly } from '../../nightly';
import { forkServer } from '../../server/server-child';
import { testSecret } from '../../server/started-server';
import { directoryWith } from '../../temporary-directory';
import { paperPlan } from '../model/studies';

export const experimenter = 'tests-Zk3vQ9xT1mB7rW5cY2nL8dF4hJ6pS0gA';
export const now = 1_800_000_000;
const software = {
  name: 'threepoint',
  version: '0.1.0',
  weights: [{ file: 'models/learned.onnx', sha256: 'ab'.repeat(32) }],
};
/** The software in an export. */
export const testSoftware = { exportedBy: software, served: [{ since: now, ...software }] };
/** The script of the thread that the server starts for its studies. */
export const studyThread = new URL('../../../server/study-thread-worker.mjs', import.meta.url);
const tokens = new RoomTokens(testSecret, () => Date.now() / 1000);
export const studySeats = createStudySeats(testSecret, (pass) => tokens.sign(pass));

interface InThisThread {
  readonly store: StudyStore;
  /** The database of the store. */
  readonly file: string;
  readonly now?: () => number;
  readonly trustProxy?: boolean;
  /** Receives the lines of the log. */
  readonly log?: (line: string) => void;
  readonly onFailedAttempt?: (guess: FailedAttempt) => void;
}

/** Returns the service of the studies in the thread of the test, which shares its store. */
export function studiesInThisThread({
  store,
  file,
  now: clock = () => now,
  trustProxy = true,
  log = (line) => expect(line).toBeNull(),
  onFailedAttempt = () => undefined,
}: InThisThread) {
  const dispatcher = new StudyDispatcher({
    ...{ store, experimenterToken: experimenter, onFailedAttempt, log },
    seats: studySeats,
    software: testSoftware.exportedBy,
    makeZip: createExporter(file),
  });
  return createStudyService({ routes: dispatcher.routes, dispatcher, now: clock, trustProxy, log });
}

/**
 * Serves the studies of a folder from their thread on a port of loopback, until the test is over. Rejects as the start
 * does. `token` null: the one in the folder.
 */
export async function servedFolder(directory: string, token: string | null = experimenter, at = 1e9) {
  const lines: string[] = [];
  const studies = await openStudyService({
    thread: studyThread,
    ...{ directory, token, secret: testSecret, software: testSoftware.exportedBy },
    now: () => at,
    trustProxy: false,
    log: (line) => lines.push(line),
  });
  const server = await serve(createRouter([studies.service], noPage));
  let open = true;
  const stop = async () => {
    if (!open) return;
    open = false;
    await server.close();
    await studies.close();
  };
  onTestFinished(stop);
  const savedToken = studies.tokenFile === null ? null : readFileSync(studies.tokenFile, 'utf8').trim();
  return { origin: `http://127.0.0.1:${server.port}`, tokenFile: studies.tokenFile, savedToken, lines, stop };
}

// biome-ignore lint/suspicious/noExplicitAny: reason: an answer over HTTP has no type; each test states it
export type Anything = any;

export interface Asked {
  readonly token?: string;
  readonly json?: unknown;
  readonly raw?: RequestInit;
  /** The client's address according to the proxy in front. */
  readonly from?: string;
}

export interface ServedOptions {
  /** The database file; absent: a new one. */
  readonly file?: string;
  readonly maxBytes?: number;
  /** Flushes the store to the disk. */
  readonly flush?: () => Promise<void>;
  /** The time after which an idle connection is closed [ms]. */
  readonly idleTimeoutMs?: number;
}

type OnFile = ServedOptions & { readonly file: string };

/** Serves the studies in the thread of the test. */
async function servedInThisThread({ file, maxBytes = 2 ** 30, flush, idleTimeoutMs = 30_000 }: OnFile) {
  const opened = openStudyStore(file, { maxBytes });
  const commits = flush && new GroupCommit(flush);
  const store = commits ? { ...opened, flushed: () => commits.flush() } : opened;
  const faults: string[] = [];
  const attempts: FailedAttempt[] = [];
  const service = studiesInThisThread({
    ...{ store, file },
    onFailedAttempt: (guess) => attempts.push(guess),
    log: (line) => faults.push(line),
  });
  const server = await serve(createRouter([service], noPage), { idleTimeoutMs });
  onTestFinished(async () => {
    await server.close();
    store.close();
    expect(faults).toEqual([]);
  });
  return { store, origin: `http://127.0.0.1:${server.port}`, failedAttempts: () => attempts };
}

/** Serves the studies by the built server, whose clock stands at `now`; the store is opened here a second time. */
async function servedByBuiltServer({ file }: OnFile) {
  const server = await forkServer({ THREEPOINT_TRUST_PROXY: '1', STUDIES: dirname(file) });
  await server.stopClock(now);
  const store = openStudyStore(file);
  onTestFinished(() => {
    store.close();
    expect(server.faults()).toEqual([]);
  });
  const attempts = () =>
    server
      .errors()
      .split('\n')
      .filter((line) => line.startsWith('study: a wrong'));
  return { store, origin: server.url, failedAttempts: attempts };
}

/**
 * Serves the studies on a port of loopback as if behind a proxy; returns the store and the failed attempts too. At
 * night the built server does so, unless something is injected.
 */
export async function servedStudies({ file = join(directoryWith(), 'studies.db'), ...injected }: ServedOptions = {}) {
  const serveFile = isNightly && Object.keys(injected).length === 0 ? servedByBuiltServer : servedInThisThread;
  const { store, origin, failedAttempts } = await serveFile({ file, ...injected });
  async function ask(method: string, path: string, { token, json, raw, from }: Asked = {}) {
    const response = await fetch(`${origin}${path}`, {
      method,
      headers: {
        ...(json !== undefined && { 'content-type': 'application/json' }),
        ...(token && { authorization: `Bearer ${token}` }),
        ...(from && { 'x-forwarded-for': from }),
      },
      ...(json !== undefined && { body: JSON.stringify(json) }),
      ...raw,
    });
    const body = Buffer.from(await response.arrayBuffer());
    const isJson = response.headers.get('content-type')?.startsWith('application/json');
    return {
      status: response.status,
      headers: response.headers,
      body,
      json: (isJson ? JSON.parse(body.toString()) : null) as Anything,
    };
  }
  return { ask, store, origin, failedAttempts };
}

/** Serves the paper's study, changed or not. */
export async function servedPaperStudy(changes: Partial<StudyPlan> = {}, options: ServedOptions = {}) {
  const server = await servedStudies(options);
  server.store.plans.add(paperPlan(changes), { simulated: false, at: now });
  /** Returns the invitation in a participant's link. */
  const invited = (participant: string) => ({
    invitation: server.store.overview('paper', now).find((state) => state.participant === participant)?.invitation,
  });
  const claim = async (participant: string): Promise<string> => {
    const path = `/api/studies/paper/participants/${participant}/claim`;
    return (await server.ask('POST', path, { json: invited(participant) })).json.token;
  };
  return { ...server, invited, claim };
}
