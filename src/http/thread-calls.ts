import { type MessagePort, Worker } from 'node:worker_threads';

/** The functions of a thread. Arguments and results are copied; bytes that fill their buffer are transferred. */
type ThreadApi = { readonly [name: string]: (...args: never[]) => unknown };

export interface ThreadLimits {
  /** The most unfinished calls, those whose caller has timed out included. */
  readonly maxCalls: number;
  /** The most bytes of their arguments. */
  readonly maxBytes: number;
  /** How long a caller waits [ms]. */
  readonly deadlineMs: number;
}

/** A call has no result, because the thread is busy or has ended. */
export class ThreadUnavailable extends Error {
  /**
   * full: the call was not made. late: the call timed out, and may still run. ended: the thread ended, perhaps after
   * the call.
   */
  readonly reason: 'full' | 'late' | 'ended';

  constructor(reason: ThreadUnavailable['reason']) {
    super(`the thread is unavailable: ${reason}`);
    this.reason = reason;
  }
}

interface CallMessage {
  readonly id: number;
  readonly name: string;
  readonly args: readonly unknown[];
  /** Deadline by `clockMs`, after which the thread skips the call; null: none. */
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

/** Returns the time of a monotonic clock that all threads of the process share [ms]. */
const clockMs = (): number => Number(process.hrtime.bigint() / 1_000_000n);

/** Returns the byte arrays among these values and in their fields. */
function bytesIn(values: readonly unknown[]): readonly Uint8Array<ArrayBuffer>[] {
  return values.flatMap((value) => {
    if (value instanceof Uint8Array) return [value as Uint8Array<ArrayBuffer>];
    return typeof value === 'object' && value !== null ? bytesIn(Object.values(value)) : [];
  });
}

/** Returns the buffers that such byte arrays fill, which can be transferred. */
const buffersIn = (values: readonly unknown[]): ArrayBuffer[] =>
  bytesIn(values).flatMap(({ byteLength, buffer }) => (byteLength === buffer.byteLength ? [buffer] : []));

/**
 * Starts a thread with this JavaScript file: NAME-worker.mjs, which loads NAME-work.ts and is itself that work in the
 * built server.
 */
export const startThread = (script: URL, workerData?: object): Worker =>
  new Worker(script, { workerData, execArgv: [] });

/** Calls the functions of a thread, within limits: if the thread hangs, callers wait for `deadlineMs` at most. */
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
    worker.on('messageerror', (error) => log(`a message of the thread could not be read: ${error.message}`));
  }

  /**
   * Calls a function. Rejects with ThreadUnavailable if the thread is full or late, and with the text of an error that
   * the function throws.
   */
  call<Name extends keyof Api & string>(
    name: Name,
    args: Parameters<Api[Name]>,
    { patient = false } = {},
  ): Promise<Awaited<ReturnType<Api[Name]>>> {
    const { maxCalls, maxBytes, deadlineMs } = this.#limits;
    const bytes = bytesIn(args).reduce((sum, { byteLength }) => sum + byteLength, 0);
    if (this.#waiting.size >= maxCalls || this.#bytes + bytes > maxBytes) {
      return Promise.reject(new ThreadUnavailable('full'));
    }
    this.#last += 1;
    const id = this.#last;
    this.#bytes += bytes;
    return new Promise((resolve, reject) => {
      const until = patient ? null : clockMs() + deadlineMs;
      // Timers count from the start of the event loop's turn: an early one would reject a call that is still run.
      const expire = (): void => {
        if (until !== null && clockMs() <= until) timer = setTimeout(expire, 1);
        else reject(new ThreadUnavailable('late'));
      };
      let timer = patient ? undefined : setTimeout(expire, deadlineMs);
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
      const question: CallMessage = { id, name, args, until };
      this.#worker.postMessage(question, buffersIn(args));
    });
  }

  /** Rejects all unfinished calls, after the thread has ended. */
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

/** Answers, in the thread, the calls that arrive at this port. A call past its deadline is skipped. */
export function answerCalls<Api extends ThreadApi>(port: MessagePort, api: Api): void {
  const answer = async ({ id, name, args, until }: CallMessage): Promise<void> => {
    try {
      const late = until !== null && clockMs() > until;
      const result = late ? undefined : await api[name as keyof Api]?.(...(args as never[]));
      port.postMessage({ id, result } satisfies Message, buffersIn([result]));
    } catch (error) {
      port.postMessage({ id, fault: error instanceof Error ? (error.stack ?? error.message) : String(error) });
    }
  };
  port.on('message', (question: CallMessage) => void answer(question));
}

/** Returns a function that sends a line from the thread to the log of the process. */
export const logFrom =
  (port: MessagePort) =>
  (line: string): void =>
    port.postMessage({ log: line } satisfies Message);
