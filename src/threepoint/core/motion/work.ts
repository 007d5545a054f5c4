/**
 * Long work in pieces. It yields the fraction [0, 1] that is done, so that its caller can show progress, yield to other
 * tasks or stop.
 */
export type Work<Result> = Generator<number, Result> | AsyncGenerator<number, Result>;

/** Runs work as a part of longer work: its progress [0, 1] is scaled to the range from `from` to `to`. */
export async function* scaleProgressAsync<Result>(
  work: Work<Result>,
  from: number,
  to: number,
): AsyncGenerator<number, Result> {
  for (;;) {
    const step = await work.next();
    if (step.done) return step.value;
    yield from + (to - from) * step.value;
  }
}

/** Runs work that never waits as a part of longer work, like `scaleProgressAsync`. */
export function* scaleProgress<Result>(
  work: Generator<number, Result>,
  from: number,
  to: number,
): Generator<number, Result> {
  for (;;) {
    const step = work.next();
    if (step.done) return step.value;
    yield from + (to - from) * step.value;
  }
}

/** Runs work synchronously to its end and returns the result. */
export function finishWork<Result>(work: Generator<unknown, Result>): Result {
  for (;;) {
    const step = work.next();
    if (step.done) return step.value;
  }
}

/** The clock and the event loop of the program that does the work. */
export interface WorkHost {
  /** Milliseconds of a monotonic clock. */
  now(): number;
  /** Resolves in a later turn of the event loop, after frames and input. */
  nextTurn(): Promise<void>;
}

/** The time slice [ms] of work between frames and input: half of a frame at 60 Hz. */
const turnMs = 8;

/**
 * Runs long work in time slices of a few milliseconds, so that a page keeps drawing. `onStep` receives what each step
 * yields and may throw to stop the work. Rejects with what it or the work throws.
 */
export async function runInTurns<Step, Result>(
  work: Generator<Step, Result> | AsyncGenerator<Step, Result>,
  host: WorkHost,
  onStep?: (step: Step) => void,
): Promise<Result> {
  let turnBegan = host.now();
  try {
    for (;;) {
      const step = await work.next();
      if (step.done) return step.value;
      if (host.now() - turnBegan >= turnMs) {
        await host.nextTurn();
        turnBegan = host.now();
      }
      onStep?.(step.value);
    }
  } finally {
    // The work closes what it holds open; after its end this does nothing.
    await work.return(undefined as Result);
  }
}

/**
 * Returns the estimated seconds left of work whose fraction [0, 1] took `elapsedSeconds`; null: too little is done for
 * an estimate. Exact for work at an even pace.
 */
export const secondsLeft = (fraction: number, elapsedSeconds: number): number | null =>
  fraction >= 0.02 && elapsedSeconds > 0 ? (elapsedSeconds * (1 - fraction)) / fraction : null;
