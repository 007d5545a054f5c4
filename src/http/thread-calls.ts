import { type MessagePort, Worker } from 'node:worker_threads';

/** The functions that a thread offers. Arguments and results are copied; bytes that have a buffer to themselves are transferred. */
export type ThreadApi = { readonly [name: string]: (...args: never[]) => unknown };

export interface ThreadLimits {
  /** Calls that the thread has not finished, those that nobody waits for any more included. */
  readonly mostCalls: number;
  /** Bytes of their arguments. */
  readonly mostBytes: number;
  /** How long a caller waits [ms]. */
  readonly deadlineMs: number;
}

/** The reason why a call has no result. */
export class ThreadUnavailable extends Error {
  /** full: nothing was asked. late: whether it is done is not known. ended: the same, and the thread is gone. */
  readonly reason: 'full' | 'late' | 'ended';

  constructor(reason: ThreadUnavailable['reason']) {
    super(`the thread is unavailable: ${reason}`);
    this.reason = reason;
  }
}

interface Question {
  readonly id: number;
  readonly name: string;
  readonly args: readonly unknown[];
  /** By `clockMs`: later the thread leaves it undone; null: no limit. */
  readonly until: number | null;
}

type Message =
  | { readonly id: number; readonly result: unknown }
  | { readonly id: number; readonly fault: string }
  | { readonly log: string };

interface Waiting {
  readonly bytes: number;
  resolve(result: unknown): void;
  reject(error: Error): void;
}

/** Milliseconds of a clock that all threads of the process share and nobody sets. */
const clockMs = (): number => Number(process.hrtime.bigint() / 1_000_000n);

/** The bytes among these values, and in the fields of their objects. */
function bytesIn(values: readonly unknown[]): readonly Uint8Array<ArrayBuffer>[] {
  return values.flatMap((value) => {
    if (value instanceof Uint8Array) return [value as Uint8Array<ArrayBuffer>];
    return typeof value === 'object' && value !== null ? bytesIn(Object.values(value)) : [];
  });
}

/** The buffers that hold such bytes and nothing else. */
const buffersIn = (values: readonly unknown[]): ArrayBuffer[] =>
  bytesIn(values).flatMap(({ byteLength, buffer }) => (byteLength === buffer.byteLength ? [buffer] : []));

/** Starts a thread with this JavaScript file: NAME-worker.mjs, which loads NAME-work.ts and is itself that work in the built server. */
export const startThread = (script: URL, workerData?: object): Worker =>
  new Worker(script, { workerData, execArgv: [] });

/** What a thread or process lacked that ended by this error, as a sentence with what to do; null: the error is another one. */
export function shortageOf(error: Error): string | null {
  const text = `${(error as NodeJS.ErrnoException).code} ${error.message}`;
  if (/\b(EMFILE|ENFILE)\b/.test(text)) {
    return 'The server may not have more files open. Raise the limit: ulimit -n 1024.';
  }
  if (!/ERR_WORKER_OUT_OF_MEMORY|ERR_WORKER_INIT_FAILED|\bENOMEM\b|out of memory/i.test(text)) return null;
  return 'The memory of the server does not suffice. Give it more: NODE_OPTIONS=--max-old-space-size=512.';
}

/** Calls the functions of a thread, within limits: a thread that hangs makes its callers wait for `deadlineMs` and holds up nothing else. */
export class ThreadCalls<Api extends ThreadApi> {
  readonly #worker: Worker;
  readonly #limits: ThreadLimits;
  readonly #waiting = new Map<number, Waiting>();
  #bytes = 0;
  #last = 0;

  /** `log` receives the lines of the thread's log. */
  constructor(worker: Worker, limits: ThreadLimits, log: (line: string) => void) {
    this.#worker = worker;
    this.#limits = limits;
    worker.on('message', (message: Message) => {
      if ('log' in message) log(message.log);
      else this.#settle(message);
    });
  }

  /** Rejects with ThreadUnavailable where the thread has no room or no answer in time; an error of the function itself comes as its text. */
  call<Name extends keyof Api & string>(
    name: Name,
    args: Parameters<Api[Name]>,
    { patient = false } = {},
  ): Promise<Awaited<ReturnType<Api[Name]>>> {
    const { mostCalls, mostBytes, deadlineMs } = this.#limits;
    const bytes = bytesIn(args).reduce((sum, { byteLength }) => sum + byteLength, 0);
    if (this.#waiting.size >= mostCalls || this.#bytes + bytes > mostBytes) {
      return Promise.reject(new ThreadUnavailable('full'));
    }
    this.#last += 1;
    const id = this.#last;
    this.#bytes += bytes;
    return new Promise((resolve, reject) => {
      const timer = patient ? undefined : setTimeout(() => reject(new ThreadUnavailable('late')), deadlineMs);
      this.#waiting.set(id, {
        bytes,
        resolve(result) {
          clearTimeout(timer);
          resolve(result as Awaited<ReturnType<Api[Name]>>);
        },
        reject(error) {
          clearTimeout(timer);
          reject(error);
        },
      });
      const question: Question = { id, name, args, until: patient ? null : clockMs() + deadlineMs };
      this.#worker.postMessage(question, buffersIn(args));
    });
  }

  /** The thread has ended: rejects all calls that it has not finished. */
  end(): void {
    for (const { reject } of this.#waiting.values()) reject(new ThreadUnavailable('ended'));
    this.#waiting.clear();
    this.#bytes = 0;
  }

  #settle(message: Exclude<Message, { readonly log: string }>): void {
    const waiting = this.#waiting.get(message.id);
    if (!waiting) return;
    this.#waiting.delete(message.id);
    this.#bytes -= waiting.bytes;
    if ('fault' in message) waiting.reject(new Error(message.fault));
    else waiting.resolve(message.result);
  }
}

/** The thread's side: answers the calls that come by this port. A call whose caller has stopped waiting is left undone. */
export function answerCalls<Api extends ThreadApi>(port: MessagePort, api: Api): void {
  const answer = async ({ id, name, args, until }: Question): Promise<void> => {
    try {
      const late = until !== null && clockMs() > until;
      const result = late ? undefined : await api[name as keyof Api]?.(...(args as never[]));
      port.postMessage({ id, result } satisfies Message, buffersIn([result]));
    } catch (error) {
      port.postMessage({ id, fault: error instanceof Error ? (error.stack ?? error.message) : String(error) });
    }
  };
  port.on('message', (question: Question) => void answer(question));
}

/** The thread's side: adds a line to the log of the process. */
export const logFrom =
  (port: MessagePort) =>
  (line: string): void =>
    port.postMessage({ log: line } satisfies Message);
