import { secondsLeft, type Work } from '../core/motion/work';

/** How far long work is. */
export interface WorkProgress {
  /** Share [0, 1] that is done. */
  readonly share: number;
  /** Seconds that the rest will take at the pace so far; null: too little is done to say. */
  readonly secondsLeft: number | null;
}

export interface WorkOptions {
  /** Hears how far the work is, some ten times a second. */
  readonly onProgress?: ((progress: WorkProgress) => void) | undefined;
  /** Gives the work up: what it made so far is let go, and the promise rejects with the signal's reason. */
  readonly signal?: AbortSignal | undefined;
}

/** Work goes on for so long [ms] before frames and presses have their turn. */
const turnMs = 8;
const tellEveryMs = 100;

/** The next turn of the event loop. A message is not held back as timers are, in pages that are not looked at. */
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

/** Does long work in turns of a few milliseconds, so that a page goes on drawing. Rejects with what the work throws. */
export async function runWork<Result>(work: Work<Result>, { onProgress, signal }: WorkOptions = {}): Promise<Result> {
  const begun = performance.now();
  let turnBegan = begun;
  let told = Number.NEGATIVE_INFINITY;
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
      if (now - told >= tellEveryMs) {
        told = now;
        onProgress?.({ share: step.value, secondsLeft: secondsLeft(step.value, (now - begun) / 1000) });
      }
      if (now - turnBegan < turnMs) continue;
      await nextTurn();
      turnBegan = performance.now();
    }
  } finally {
    // The work closes what it holds open; after its end this does nothing.
    await work.return(undefined as Result);
  }
}
