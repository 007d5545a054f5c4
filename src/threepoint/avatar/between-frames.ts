import { runInTurns, type WorkHost } from '../core/motion/work';

/** Work in steps of a millisecond or so, between which other work may be done. */
export type Steps<Result> = Generator<undefined, Result>;

const host: WorkHost = {
  now: () => performance.now(),
  nextTurn: () => new Promise((resolve) => setTimeout(resolve)),
};

/** Runs the steps in turns with the page's other work, so that no frame waits for them. */
export const betweenFrames = <Result>(steps: Steps<Result>): Promise<Result> => runInTurns(steps, host);
