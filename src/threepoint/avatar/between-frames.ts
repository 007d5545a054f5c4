import { runInTurns, type WorkHost } from '../core/motion/work';

/** Work in steps of about a millisecond, between which other work can run. */
export type Steps<Result> = Generator<undefined, Result>;

const host: WorkHost = {
  now: () => performance.now(),
  nextTurn: () => new Promise((resolve) => setTimeout(resolve)),
};

/** Runs the steps between the page's frames. */
export const betweenFrames = <Result>(steps: Steps<Result>): Promise<Result> => runInTurns(steps, host);
