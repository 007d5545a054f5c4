/** Starts a validator of avatar files. The published package has scripts/library/embedded-validator.ts instead. */
export const startValidator = async (): Promise<Worker> =>
  new Worker(new URL('../avatar/file/avatar-check-worker.ts', import.meta.url), { type: 'module' });
