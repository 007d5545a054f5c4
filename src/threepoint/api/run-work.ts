import { secondsLeft, type Work } from '../core/motion/work';

/** The progress of long work. */
export interface WorkProgress {
  /** The share [0, 1] that is done. */
  readonly share: number;
  /** The estimated time left [s]; null: too little is done for an estimate. */
  readonly secondsLeft: number | null;
}

export interface WorkOptions {
  /** Called with the progress about ten times a second. */
  readonly onProgress?: ((progress: WorkProgress) => void) | undefined;
  /** Aborts the work: partial results are discarded, and the promise rejects with the signal's reason. */
  readonly signal?: AbortSignal | undefined;
}

/** The time slice [ms] of the work before the browser may draw and handle input. */
const turnMs = 8;
const reportEveryMs = 100;

/** Resolves in the next turn of the event loop. Messages, unlike timers, are not throttled in background pages. */
function nextTurn(): Promise<void> {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(null);
  });
}

/** Runs long work in slices of a few milliseconds, so that a page keeps drawing. Rejects with what the work throws. */
export async function runWork<Result>(work: Work<Result>, { onProgress, signal }: WorkOptions = {}): Promise<Result> {
  const begun = performance.now();
  let turnBegan = begun;
  let reportedAt = Number.NEGATIVE_INFINITY;
  try {
    for (;;) {
      signal?.throwIfAborted();
      const step = await work.next();
      if (step.done) {
        signal?.throwIfAborted();
        onProgress?.({ share: 1, secondsLeft: 0 });
        return step.value;
      }
      const now = performance.now();
      if (now - reportedAt >= reportEveryMs) {
        reportedAt = now;
        onProgress?.({ share: step.value, secondsLeft: secondsLeft(step.value, (now - begun) / 1000) });
      }
      if (now - turnBegan < turnMs) continue;
      await nextTurn();
      turnBegan = performance.now();
    }
  } finally {
    // The work closes its open resources; after its end this has no effect.
    await work.return(undefined as Result);
  }
}
