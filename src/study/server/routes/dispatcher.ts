import { checked, identifier, participantId } from 'threepoint/core';
import { errorLine, errorResponse, HttpError, type HttpResponse, internalError, rejectionOf } from 'threepoint-http';
import { Rejection } from '../../model/progress/rejection';
import type { StudyStorage } from '../study-storage';
import { type Effect, failureSentence } from './effect';
import { createStudyGuard, type Sender, type StudyGuard, type StudyGuardOptions } from './guard';
import { participantRoutes } from './participant-routes';
import type { StudyParts, StudyRequest, StudyRoute } from './route';
import { studyRoutes } from './study-routes';

/** How long a request waits for the lock of another program, and the interval of its attempts [ms]. */
const lockedMs = 5000;
const retryMs = 20;
/** The shortest interval between two log entries about a fault of the disk or the folder [ms]. */
const logEveryMs = 60_000;

const wait = (ms: number) => new Promise<void>((resolve) => setTimeout(resolve, ms));

/**
 * Repeats a function that throws "locked" before it changes anything, until it succeeds or the time [of
 * performance.now] is over.
 */
async function untilUnlocked<T>(until: number, run: () => T | Promise<T>): Promise<T> {
  for (;;) {
    try {
      return await run();
    } catch (error) {
      const isLocked = error instanceof Rejection && error.reason === 'locked';
      if (!isLocked || performance.now() > until) throw error;
      await wait(retryMs);
    }
  }
}

/** Returns the sender and the checked names of a request. */
const senderOf = ({ token, address, names }: StudyRequest): Sender => ({
  ...{ token, address },
  study: names.study === undefined ? '' : checked(identifier, names.study),
  participant: names.participant === undefined ? '' : checked(participantId, names.participant),
});

/** The time after which a page repeats its request if the database is locked or busy [s]. */
export const retryAfterSeconds = 5;

/** Returns the HTTP error for an error of a request with this effect, or null for a fault of the server. */
function httpErrorOf(error: unknown, effect: Effect): HttpError | null {
  if (!(error instanceof Rejection)) return rejectionOf(error);
  const { reason, field, failure } = error;
  const message = failure === null ? error.message : failureSentence(error.message, effect, failure === 'not done');
  // The page for withdrawals takes 507 for a sign that nothing was deleted.
  const isUnknown = reason === 'lost' && failure !== 'not done';
  const status = isUnknown && effect === 'withdraws' ? 503 : error.status;
  const headers = status === 503 ? { 'retry-after': String(retryAfterSeconds) } : {};
  return new HttpError(status, message, { field, headers });
}

export interface StudyDispatcherOptions extends Omit<StudyParts, 'guard'>, StudyGuardOptions {
  readonly store: StudyStorage;
  readonly log: (line: string) => void;
}

/**
 * Runs the requests to the routes below /api/studies. Requests that change something run one after the other and are
 * answered when the change is on the disk. While one of them waits for the lock of another program, requests that only
 * read go on.
 */
export class StudyDispatcher {
  readonly routes: readonly StudyRoute[];
  readonly #guard: StudyGuard;
  readonly #store: StudyStorage;
  readonly #log: (line: string) => void;
  #lastChange: Promise<unknown> = Promise.resolve();
  #logged = Number.NEGATIVE_INFINITY;

  constructor({ experimenterToken, onFailedAttempt, log, ...parts }: StudyDispatcherOptions) {
    const { store } = parts;
    const guard = createStudyGuard({ store, experimenterToken, onFailedAttempt });
    this.routes = [...studyRoutes({ ...parts, guard }), ...participantRoutes({ ...parts, guard })];
    this.#guard = guard;
    this.#store = store;
    this.#log = log;
  }

  /** Resolves with the answer to a request that is not permitted, before its body is read; undefined: it is. */
  async admit(request: StudyRequest): Promise<HttpResponse | undefined> {
    const { access, effect } = this.#routeOf(request);
    try {
      await untilUnlocked(performance.now() + lockedMs, () => this.#guard.admit(access, senderOf(request)));
      return undefined;
    } catch (error) {
      return this.#answerTo(error, effect);
    }
  }

  /** Handles a request. If its route takes a body, it was admitted before. */
  async handle(request: StudyRequest, body: Uint8Array<ArrayBuffer>): Promise<HttpResponse> {
    const route = this.#routeOf(request);
    const changes = route.effect !== 'reads';
    try {
      const sender = senderOf(request);
      const call = { ...sender, at: request.at, query: new URLSearchParams(request.query), body };
      const until = performance.now() + lockedMs;
      if (route.bodyLimit === 0) await untilUnlocked(until, () => this.#guard.admit(route.access, sender));
      const run = () => untilUnlocked(until, () => route.handle(call));
      const answer = await (changes ? this.#afterEarlierChanges(run) : run());
      if (changes) await this.#store.flushed();
      const text = answer.body;
      return typeof text === 'string' ? { ...answer, body: new TextEncoder().encode(text) } : answer;
    } catch (error) {
      return this.#answerTo(error, route.effect);
    }
  }

  #routeOf({ route: { method, path } }: StudyRequest): StudyRoute {
    return this.routes.find((one) => one.method === method && one.path === path) as StudyRoute;
  }

  #afterEarlierChanges<T>(run: () => Promise<T>): Promise<T> {
    const result = this.#lastChange.then(run);
    // A request neither fails with the error of the one before it nor keeps its result.
    const over = () => undefined;
    this.#lastChange = result.then(over, over);
    return result;
  }

  #answerTo(error: unknown, effect: Effect): HttpResponse {
    if (error instanceof Rejection && error.reason === 'lost') this.#logLost(error);
    const known = httpErrorOf(error, effect);
    if (!known) this.#log(`study: ${errorLine(error)}`);
    return errorResponse(known ?? internalError());
  }

  #logLost({ message, detail }: Rejection): void {
    if (performance.now() - this.#logged < logEveryMs) return;
    this.#logged = performance.now();
    this.#log(`study: ${message}${detail === null ? '' : ` (${detail})`}`);
  }
}
