/**
 * Starts a worker that validates files of avatars; null: there are no workers of the web, as in Node, where
 * onnxruntime-web sets this global to those of worker_threads. The published package has
 * scripts/library/embedded-validator.ts instead.
 */
export const startValidator = async (): Promise<Worker | null> =>
  globalThis.Worker?.prototype instanceof EventTarget
    ? new Worker(new URL('../../avatar/file/avatar-check-worker.ts', import.meta.url), { type: 'module' })
    : null;
