import type { ValidatorAnswer } from './validator-worker';

/** A file that keeps the validator busy for longer [ms] is not worth the wait. */
const patienceMs = 20_000;

/**
 * What the Khronos validator finds wrong with a GLB file, found in a worker that lives no longer than the question: neither a slow
 * file nor one that breaks the validator touches the picture. Rejects with a sentence.
 */
export function validateInWorker(bytes: Uint8Array): Promise<readonly string[]> {
  const worker = new Worker(new URL('./validator-worker.ts', import.meta.url), { type: 'module' });
  return new Promise<readonly string[]>((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error('checking it takes too long')), patienceMs);
    worker.addEventListener('message', ({ data: answer }: MessageEvent<ValidatorAnswer>) => {
      clearTimeout(timer);
      if ('faults' in answer) resolve(answer.faults);
      else reject(new Error(`it cannot be checked (${answer.broken})`));
    });
    worker.addEventListener('error', ({ message }) => {
      clearTimeout(timer);
      reject(new Error(`it cannot be checked (${message || 'the validator did not start'})`));
    });
    worker.postMessage(bytes);
  }).finally(() => worker.terminate());
}
