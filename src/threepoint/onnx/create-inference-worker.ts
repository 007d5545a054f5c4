export const createInferenceWorker = (): Worker =>
  new Worker(new URL('./inference-worker.ts', import.meta.url), { type: 'module' });
