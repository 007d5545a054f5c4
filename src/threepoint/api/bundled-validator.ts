/** Starts a worker that validates files of avatars. */
export const startValidator = async (): Promise<Worker> =>
  new Worker(new URL('../avatar/file/avatar-check-worker.ts', import.meta.url), { type: 'module' });
