import type { HttpResponse } from 'threepoint-http/response';
import { StoreRefusal } from '../storage/store-refusal';
import type { StudyStore } from '../storage/study-store';
import type { StudyRequest, StudyRoute } from './route';
import { refusalOf, type StudyRoutes } from './routes';

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

export interface StudyDispatcherOptions {
  readonly routes: StudyRoutes;
  readonly store: Pick<StudyStore, 'flushed'>;
  readonly log: (line: string) => void;
}

/**
 * Runs the requests to the studies. Requests that change something run one after the other and are answered when the
 * change is on the disk. While one of them waits for the lock of another program, requests that only read go on.
 */
export class StudyDispatcher {
  readonly #options: StudyDispatcherOptions;
  #lastChange: Promise<unknown> = Promise.resolve();
  #logged = Number.NEGATIVE_INFINITY;

  constructor(options: StudyDispatcherOptions) {
    this.#options = options;
  }

  /** Resolves with whether the request is permitted, before its body is read; `index` is that of the route. */
  admit(index: number, request: StudyRequest): Promise<StudyOutcome> {
    const { routes } = this.#options;
    return this.#outcome(async () => {
      const route = routes.routes[index] as StudyRoute;
      await untilUnlocked(performance.now() + lockedMs, () => routes.admit(route, request));
      return { status: 204 };
    });
  }

  /** Handles a request. If its route takes a body, it was admitted before. */
  handle(index: number, request: StudyRequest, body: Uint8Array<ArrayBuffer>): Promise<StudyOutcome> {
    const { routes, store } = this.#options;
    return this.#outcome(async () => {
      const route = routes.routes[index] as StudyRoute;
      const until = performance.now() + lockedMs;
      if (route.bodyLimit === 0) await untilUnlocked(until, () => routes.admit(route, request));
      const run = () => untilUnlocked(until, () => routes.handle(route, request, body));
      const answer = await (route.changes ? this.#afterOthers(run) : run());
      if (route.changes) await store.flushed();
      const text = answer.body;
      return typeof text === 'string' ? { ...answer, body: new TextEncoder().encode(text) } : answer;
    });
  }

  #afterOthers<T>(run: () => Promise<T>): Promise<T> {
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
    this.#options.log(`study: ${message}${detail === null ? '' : ` (${detail})`}`);
  }
}
