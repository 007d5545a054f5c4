import { checked, identifier, participantId } from 'threepoint/core';
import { HttpError, type HttpResponse, refusalOf as knownRefusalOf } from 'threepoint-http';
import { StoreRefusal } from '../storage/store-refusal';
import type { StudyStore } from '../storage/study-store';
import { createStudyGuard, type Sender, type StudyGuard, type StudyGuardOptions } from './guard';
import { participantRoutes } from './participant-routes';
import type { StudyParts, StudyRequest, StudyRoute } from './route';
import { studyRoutes } from './study-routes';

/** The result of a request, in a form that can be sent between threads. */
export type StudyOutcome =
  | { readonly answer: HttpResponse }
  | {
      readonly refused: {
        readonly status: number;
        readonly message: string;
        readonly field: string | null;
        readonly headers: Readonly<Record<string, string>>;
      };
    }
  /** A fault of the server, for its log. */
  | { readonly fault: string };

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
      const isLocked = error instanceof StoreRefusal && error.reason === 'locked';
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

const statusOfRefusal = {
  ...{ unknown: 404, conflict: 409, begun: 409, forbidden: 403, locked: 503, busy: 503, full: 507, lost: 507 },
} as const satisfies Readonly<Record<StoreRefusal['reason'], number>>;

/** The time after which a page repeats its request if the database is locked or busy [s]. */
export const retryAfterSeconds = 5;

/** Returns the HTTP error for an error, or null for a fault of the server. */
export function refusalOf(error: unknown): HttpError | null {
  if (!(error instanceof StoreRefusal)) return knownRefusalOf(error);
  const { reason, message } = error;
  return new HttpError(statusOfRefusal[reason], message, {
    field: reason === 'begun' ? 'newVersion' : null,
    headers: statusOfRefusal[reason] === 503 ? { 'retry-after': String(retryAfterSeconds) } : {},
  });
}

export interface StudyDispatcherOptions extends Omit<StudyParts, 'guard'>, StudyGuardOptions {
  readonly store: StudyStore;
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
  readonly #store: StudyStore;
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

  /** Resolves with whether the request is permitted, before its body is read; `index` is that of the route. */
  admit(index: number, request: StudyRequest): Promise<StudyOutcome> {
    return this.#outcome(async () => {
      const { access } = this.routes[index] as StudyRoute;
      await untilUnlocked(performance.now() + lockedMs, () => this.#guard.admit(access, senderOf(request)));
      return { status: 204 };
    });
  }

  /** Handles a request. If its route takes a body, it was admitted before. */
  handle(index: number, request: StudyRequest, body: Uint8Array<ArrayBuffer>): Promise<StudyOutcome> {
    return this.#outcome(async () => {
      const route = this.routes[index] as StudyRoute;
      const sender = senderOf(request);
      const call = { ...sender, at: request.at, query: new URLSearchParams(request.query), body };
      const until = performance.now() + lockedMs;
      if (route.bodyLimit === 0) await untilUnlocked(until, () => this.#guard.admit(route.access, sender));
      const run = () => untilUnlocked(until, () => route.handle(call));
      const answer = await (route.changes ? this.#afterEarlierChanges(run) : run());
      if (route.changes) await this.#store.flushed();
      const text = answer.body;
      return typeof text === 'string' ? { ...answer, body: new TextEncoder().encode(text) } : answer;
    });
  }

  #afterEarlierChanges<T>(run: () => Promise<T>): Promise<T> {
    const result = this.#lastChange.then(run);
    // A request neither fails with the error of the one before it nor keeps its result.
    const over = () => undefined;
    this.#lastChange = result.then(over, over);
    return result;
  }

  async #outcome(run: () => Promise<HttpResponse>): Promise<StudyOutcome> {
    try {
      return { answer: await run() };
    } catch (error) {
      if (error instanceof StoreRefusal && error.reason === 'lost') this.#logLost(error);
      const known = refusalOf(error);
      if (!known) return { fault: error instanceof Error ? (error.stack ?? error.message) : String(error) };
      const { status, message, field, headers } = known;
      return { refused: { status, message, field, headers } };
    }
  }

  #logLost({ message, detail }: StoreRefusal): void {
    if (performance.now() - this.#logged < logEveryMs) return;
    this.#logged = performance.now();
    this.#log(`study: ${message}${detail === null ? '' : ` (${detail})`}`);
  }
}
