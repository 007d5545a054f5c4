import type { IncomingMessage } from 'node:http';
import type { Worker } from 'node:worker_threads';
import { reasonOf } from 'threepoint/core';
import {
  type Call,
  ConfigurationError,
  errorLine,
  findClientAddress,
  HttpError,
  type Route,
  type Service,
  shortageOf,
  startThread,
  ThreadCalls,
  ThreadUnavailable,
} from 'threepoint-http';
import { retryAfterSeconds, type StudyDispatcher } from './routes/dispatcher';
import { failureSentence } from './routes/effect';
import type { RouteAccess } from './routes/guard';
import type { RouteHead, StudyRequest } from './routes/route';
import type { OpenedStudies, StudyThreadApi, StudyThreadOptions } from './thread';

export interface StudyServiceOptions extends StudyThreadOptions {
  /** The script of the thread, which calls serveStudies. */
  readonly thread: URL;
  /** Seconds since 1970. */
  readonly now: () => number;
  /** Whether the headers of a proxy about a client's address are trusted. */
  readonly trustProxy: boolean;
  /** Called with a line about each fault, failed attempt and deletion by the retention date. */
  readonly log: (line: string) => void;
}

export interface StudyService {
  readonly service: Service;
  /** The file with the generated token; null: the token was given. */
  readonly tokenFile: string | null;
  close(): Promise<void>;
}

/** Enough for the requests of two hundred participants while the disk hangs, with recordings of a few of them. */
const limits = { maxCalls: 1024, maxBytes: 64 * 2 ** 20, deadlineMs: 10_000 } as const;
/** The shortest interval between two starts of the thread [ms]. */
const restartMs = 1000;
/** How long closing the server waits for a disk [ms]. */
const closingMs = 5000;
const hourMs = 3_600_000;

const unavailable = (message: string): HttpError =>
  new HttpError(503, message, { headers: { 'retry-after': String(retryAfterSeconds) } });

const causes = {
  full: 'too many requests to the studies',
  late: 'the database did not answer in time',
  ended: 'the studies were interrupted',
} as const;

/** The thread of the studies. After a fault, such as a lack of memory, the next request starts it again. */
class StudyThread {
  readonly #options: StudyServiceOptions;
  #worker: Worker | null = null;
  #calls: ThreadCalls<StudyThreadApi> | null = null;
  #startedAt = Number.NEGATIVE_INFINITY;

  constructor(options: StudyServiceOptions) {
    this.#options = options;
  }

  /** Starts the thread; throws if it cannot open the folder. */
  async open(): Promise<Exclude<OpenedStudies, { readonly problem: string }>> {
    const { directory, token, software, secret, now, log, thread } = this.#options;
    this.#startedAt = performance.now();
    const worker = startThread(thread);
    const calls = new ThreadCalls<StudyThreadApi>(worker, limits);
    this.#worker = worker;
    this.#calls = calls;
    let shortage: string | null = null;
    worker.on('error', (error) => {
      shortage = shortageOf(error);
      log(`study: ${shortage ?? errorLine(error)}`);
    });
    worker.on('message', log);
    worker.once('exit', () => {
      if (this.#worker === worker) this.#worker = this.#calls = null;
    });
    const asked = [{ directory, token, software, secret }, now()] as const;
    try {
      const opened = await calls.call('open', [...asked], { patient: true });
      if (!('problem' in opened)) return opened;
      throw new ConfigurationError(opened.problem);
    } catch (error) {
      await worker.terminate();
      throw shortage === null ? error : new ConfigurationError(shortage);
    }
  }

  /** Calls the thread; rejects with a ThreadUnavailable if it is overloaded, late or ended. */
  async call<Name extends keyof StudyThreadApi>(
    name: Name,
    args: Parameters<StudyThreadApi[Name]>,
    options?: { readonly patient: boolean },
  ): Promise<Awaited<ReturnType<StudyThreadApi[Name]>>> {
    const calls = this.#calls ?? this.#restarted();
    return calls.call(name, args, options);
  }

  /** Runs a request in the thread; rejects with an HttpError 503 if the thread is overloaded, late or ended. */
  async request<Name extends 'admit' | 'handle'>(
    name: Name,
    ...args: Parameters<StudyThreadApi[Name]>
  ): Promise<Awaited<ReturnType<StudyThreadApi[Name]>>> {
    const { effect, isPatient } = args[0].route;
    try {
      return await this.call(name, args, { patient: isPatient && name === 'handle' });
    } catch (error) {
      if (!(error instanceof ThreadUnavailable)) throw error;
      const sentence = failureSentence(causes[error.reason], effect, error.reason === 'full');
      const again = error.reason === 'full' && effect === 'stores' ? '. Send it again in a few seconds' : '';
      throw unavailable(`${sentence}${again}`);
    }
  }

  /** Ends the thread when the database is closed, or when its disk hangs for too long. */
  async close(): Promise<void> {
    const [worker, calls] = [this.#worker, this.#calls];
    if (!worker || !calls) return;
    const late = new Promise<void>((resolve) => setTimeout(resolve, closingMs).unref());
    await Promise.race([calls.call('close', [], { patient: true }), late]);
    this.#worker = this.#calls = null;
    // A thread that waits for a disk cannot be ended, and the process waits for it.
    await Promise.race([worker.terminate(), late]);
  }

  #restarted(): ThreadCalls<StudyThreadApi> {
    if (performance.now() - this.#startedAt < restartMs) throw new ThreadUnavailable('ended');
    const { log } = this.#options;
    log('study: the thread of the database ended; it starts again');
    this.open().catch((error: unknown) => log(`study: the thread of the database did not start: ${reasonOf(error)}`));
    if (!this.#calls) throw new ThreadUnavailable('ended');
    return this.#calls;
  }
}

function bearerOf(request: IncomingMessage): string | null {
  return /^Bearer ([\w~+/.-]{1,256}=*)$/.exec(request.headers.authorization ?? '')?.[1] ?? null;
}

/**
 * Resolves with the answer that a client waits for. Its connection is silent until then and would be closed otherwise.
 */
async function awaited<T>({ socket }: IncomingMessage, answer: Promise<T>): Promise<T> {
  const silenceMs = socket.timeout ?? 0;
  socket.setTimeout(0);
  try {
    return await answer;
  } finally {
    socket.setTimeout(silenceMs);
  }
}

export interface ServiceOptions extends Pick<StudyServiceOptions, 'now' | 'trustProxy' | 'log'> {
  readonly routes: readonly RouteHead[];
  /** Runs the requests, in this thread or another one. */
  readonly dispatcher: Pick<StudyDispatcher, 'admit' | 'handle'>;
}

/** Returns the service of the studies: all routes below /api/studies. */
export function createStudyService({ routes, dispatcher, now, trustProxy, log }: ServiceOptions): Service<RouteAccess> {
  const requestOf = (route: RouteHead, { request, names, query }: Omit<Call, 'body'>): StudyRequest => ({
    ...{ route, at: now(), token: bearerOf(request), address: findClientAddress(request, trustProxy) },
    ...{ names, query: query.toString() },
  });
  return {
    routes: routes.map((head) => ({
      ...{ ...head, head },
      handle(call) {
        const answer = dispatcher.handle(requestOf(head, call), call.body);
        return head.isPatient ? awaited(call.request, answer) : answer;
      },
    })),
    // Without a body, admission and handling are one call to the thread.
    admit: ({ head }: Route<RouteAccess> & { readonly head: RouteHead }, call) =>
      head.bodyLimit === 0 ? undefined : dispatcher.admit(requestOf(head, call)),
    onError: (error) => log(`study: ${errorLine(error)}`),
  };
}

/** Opens the studies of this server: their thread, their routes and the hourly deletion by retention dates. */
export async function openStudyService(options: StudyServiceOptions): Promise<StudyService> {
  const { now, trustProxy, log } = options;
  const thread = new StudyThread(options);
  const { routes, tokenFile } = await thread.open();
  const expire = () =>
    thread.call('expire', [now()], { patient: true }).catch((error: unknown) => log(`study: ${reasonOf(error)}`));
  await expire();
  const timer = setInterval(expire, hourMs);
  timer.unref();
  const service = createStudyService({
    ...{ routes, now, trustProxy, log },
    dispatcher: {
      admit: (request) => thread.request('admit', request),
      handle: (request, body) => thread.request('handle', request, body),
    },
  });
  return {
    service,
    tokenFile,
    async close() {
      clearInterval(timer);
      await thread.close();
    },
  };
}
