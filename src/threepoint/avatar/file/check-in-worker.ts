import { createWorkerCheck } from './avatar-check-client';
import type { AvatarCheck } from './check-avatar';
import { hasWebWorkers } from './node-worker';

/** Checks a file in a worker of this page; if none starts, the file is refused. */
export const checkInWorker: AvatarCheck = createWorkerCheck(
  () => (hasWebWorkers() ? new Worker(new URL('./avatar-check-worker.ts', import.meta.url), { type: 'module' }) : null),
  async (_, { name }) => {
    throw new Error(`${name}: could not be checked (the validator did not start)`);
  },
);
