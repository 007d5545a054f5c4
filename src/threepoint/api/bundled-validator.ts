import { hasWebWorkers } from '../avatar/file/node-worker';

/** Starts a worker that validates files of avatars; null: there are no workers here. */
export const startValidator = async (): Promise<Worker | null> =>
  hasWebWorkers()
    ? new Worker(new URL('../avatar/file/avatar-check-worker.ts', import.meta.url), { type: 'module' })
    : null;
