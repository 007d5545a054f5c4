import type { AvatarCheck, CheckedAvatar } from './check-avatar';
import type { WorkerAnswer, WorkerQuestion } from './check-worker';
import { MotionWithoutBody } from './inspect-avatar';

/** A file that keeps its check busy for longer [ms] is not worth the wait. */
const patienceMs = 20_000;

/**
 * The check in a worker that lives no longer than the question: neither a slow file nor one that breaks the validator
 * touches the picture. The bytes go there and come back without being copied: those given are empty afterwards.
 */
export const checkInWorker: AvatarCheck = (bytes, { name, unpacked, limits }) => {
  const worker = new Worker(new URL('./check-worker.ts', import.meta.url), { type: 'module' });
  return new Promise<CheckedAvatar>((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error(`${name}: the check took too long`)), patienceMs);
    worker.addEventListener('message', ({ data: answer }: MessageEvent<WorkerAnswer>) => {
      clearTimeout(timer);
      if ('checked' in answer) resolve(answer.checked);
      else if ('motion' in answer) reject(new MotionWithoutBody(name));
      else reject(new Error(answer.refused));
    });
    worker.addEventListener('error', ({ message }) => {
      clearTimeout(timer);
      reject(new Error(`${name}: could not be checked (${message || 'the validator did not start'})`));
    });
    const question: WorkerQuestion = { bytes, name, unpacked, ...(limits && { limits }) };
    worker.postMessage(question, [bytes]);
  }).finally(() => worker.terminate());
};
