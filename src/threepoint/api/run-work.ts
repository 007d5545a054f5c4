import { runInTurns, secondsLeft, type Work, type WorkHost } from '../core/motion/work';

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

const tellEveryMs = 100;

const host: WorkHost = {
  now: () => performance.now(),
  // A page in the background delays timers, but not messages.
  nextTurn: () =>
    new Promise((resolve) => {
      const { port1, port2 } = new MessageChannel();
      port1.onmessage = () => {
        port1.close();
        resolve();
      };
      port2.postMessage(null);
    }),
};

/** Does long work in turns of a few milliseconds, so that a page goes on drawing. Rejects with what the work throws. */
export async function runWork<Result>(work: Work<Result>, { onProgress, signal }: WorkOptions = {}): Promise<Result> {
  signal?.throwIfAborted();
  const begun = host.now();
  let told = Number.NEGATIVE_INFINITY;
  const result = await runInTurns(work, host, (share) => {
    signal?.throwIfAborted();
    const now = host.now();
    if (now - told < tellEveryMs) return;
    told = now;
    onProgress?.({ share, secondsLeft: secondsLeft(share, (now - begun) / 1000) });
  });
  signal?.throwIfAborted();
  onProgress?.({ share: 1, secondsLeft: 0 });
  return result;
}
