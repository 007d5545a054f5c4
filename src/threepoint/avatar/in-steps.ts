/** Work in steps of about a millisecond, between which other work may run. */
export type Steps<Result> = Generator<undefined, Result>;

/** Runs all steps one after the other. */
export function atOnce<Result>(steps: Steps<Result>): Result {
  for (;;) {
    const step = steps.next();
    if (step.done) return step.value;
  }
}

/** The time slice [ms] of steps before frames and clicks: half of a frame at 60 Hz. */
const turnMs = 8;

/** Runs the steps between frames, so that no frame waits for them. */
export async function betweenFrames<Result>(steps: Steps<Result>): Promise<Result> {
  let since = performance.now();
  for (;;) {
    const step = steps.next();
    if (step.done) return step.value;
    if (performance.now() - since < turnMs) continue;
    await new Promise((resolve) => setTimeout(resolve));
    since = performance.now();
  }
}
