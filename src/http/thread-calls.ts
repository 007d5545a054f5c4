import { MessageChannel, type MessagePort, Worker } from 'node:worker_threads';

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
  readonly name: string;
  readonly args: readonly unknown[];
  /** Deadline by `clockMs`, after which the thread skips the call; null: none. */
  readonly until: number | null;
  /** The port on which the thread answers this call; it closes when the thread ends. */
  readonly port: MessagePort;
}

type Answer = { readonly result: unknown } | { readonly error: unknown };

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

/**
 * Calls the functions of a thread, within limits: if the thread hangs, callers wait for `deadlineMs` at most. Each call
 * has its own channel, so that a thread that ends rejects all of them.
 */
export class ThreadCalls<Api extends ThreadApi> {
  readonly #worker: Worker;
  readonly #limits: ThreadLimits;
  #unfinished = 0;
  #bytes = 0;

  constructor(worker: Worker, limits: ThreadLimits) {
    this.#worker = worker;
    this.#limits = limits;
  }

  /**
   * Calls a function. Rejects with ThreadUnavailable if the thread is full, late or ended, and with a copy of an error
   * that the function throws.
   */
  call<Name extends keyof Api & string>(
    name: Name,
    args: Parameters<Api[Name]>,
    { patient = false } = {},
  ): Promise<Awaited<ReturnType<Api[Name]>>> {
    const { maxCalls, maxBytes, deadlineMs } = this.#limits;
    const bytes = bytesIn(args).reduce((sum, { byteLength }) => sum + byteLength, 0);
    if (this.#unfinished >= maxCalls || this.#bytes + bytes > maxBytes) {
      return Promise.reject(new ThreadUnavailable('full'));
    }
    const { port1: answers, port2: port } = new MessageChannel();
    return new Promise((resolve, reject) => {
      const until = patient ? null : clockMs() + deadlineMs;
      const message: CallMessage = { name, args, until, port };
      this.#worker.postMessage(message, [port, ...buffersIn(args)]);
      this.#unfinished += 1;
      this.#bytes += bytes;
      // Timers count from the start of the event loop's turn: an early one would reject a call that is still run.
      const expire = (): void => {
        if (until !== null && clockMs() <= until) timer = setTimeout(expire, 1);
        else reject(new ThreadUnavailable('late'));
      };
      let timer = patient ? undefined : setTimeout(expire, deadlineMs);
      const finish = (answer: Answer): void => {
        answers.off('close', end).close();
        clearTimeout(timer);
        this.#unfinished -= 1;
        this.#bytes -= bytes;
        if ('error' in answer) reject(answer.error);
        else resolve(answer.result as Awaited<ReturnType<Api[Name]>>);
      };
      const end = () => finish({ error: new ThreadUnavailable('ended') });
      answers.once('message', finish).once('close', end);
    });
  }
}

/** Answers, in the thread, the calls that arrive at its port. A call past its deadline is skipped. */
export function answerCalls<Api extends ThreadApi>(calls: MessagePort, api: Api): void {
  calls.on('message', async ({ name, args, until, port }: CallMessage) => {
    try {
      const late = until !== null && clockMs() > until;
      const result = late ? undefined : await api[name as keyof Api]?.(...(args as never[]));
      port.postMessage({ result } satisfies Answer, buffersIn([result]));
    } catch (error) {
      port.postMessage({ error } satisfies Answer);
    }
  });
}
