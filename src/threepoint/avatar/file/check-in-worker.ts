import type { AvatarCheck } from './check-avatar';
import { workerCheck } from './worker-check';

/** Checks a file in a worker of this page; where none starts, the file is refused. */
export const checkInWorker: AvatarCheck = workerCheck(
  () => new Worker(new URL('./check-worker.ts', import.meta.url), { type: 'module' }),
  async (_, { name }) => {
    throw new Error(`${name}: could not be checked (the validator did not start)`);
  },
);
