/** Creates the worker in which the page's networks run. */
export const createInferenceWorker = (): Worker =>
  new Worker(new URL('./inference-worker.ts', import.meta.url), { type: 'module' });
