import { runInTurns, secondsLeft, type Work, type WorkHost } from '../core/motion/work';

export interface WorkProgress {
  /** The fraction [0, 1] of the work that is done. */
  readonly fraction: number;
  /** The estimated time left [s]; null: too little is done for an estimate. */
  readonly secondsLeft: number | null;
}

export interface WorkOptions {
  /** Called with the progress about ten times a second. */
  readonly onProgress?: ((progress: WorkProgress) => void) | undefined;
  /** Aborts the work: partial results are discarded, and the promise rejects with the signal's reason. */
  readonly signal?: AbortSignal | undefined;
}

const reportEveryMs = 100;

/** Resolves in a later turn of the event loop. A page in the background delays timers, but not messages. */
export const nextTurn = (): Promise<void> =>
  new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(null);
  });

const host: WorkHost = { now: () => performance.now(), nextTurn };

/** Runs long work in slices of a few milliseconds, so that a page keeps drawing. Rejects with what the work throws. */
export async function runWork<Result>(work: Work<Result>, { onProgress, signal }: WorkOptions = {}): Promise<Result> {
  signal?.throwIfAborted();
  const begun = host.now();
  let reportedAt = Number.NEGATIVE_INFINITY;
  const result = await runInTurns(work, host, (fraction) => {
    signal?.throwIfAborted();
    const now = host.now();
    if (now - reportedAt < reportEveryMs) return;
    reportedAt = now;
    onProgress?.({ fraction, secondsLeft: secondsLeft(fraction, (now - begun) / 1000) });
  });
  signal?.throwIfAborted();
  onProgress?.({ fraction: 1, secondsLeft: 0 });
  return result;
}
