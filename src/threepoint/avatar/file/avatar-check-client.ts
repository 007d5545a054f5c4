import type { AvatarCheckRequest, AvatarCheckResponse } from './avatar-check-worker';
import type { AvatarCheck, CheckedAvatar } from './check-avatar';
import { MotionOnlyError } from './motion-only-error';

/** The longest time [ms] that the start of a worker, and its check, may take. */
const patienceMs = 20_000;

/** Starts a worker of avatar-check-worker.ts; null: there are no workers here. */
type StartWorker = () => Worker | null | Promise<Worker | null>;

/** Resolves when a worker of avatar-check-worker.ts has reported that it runs, or to null where it does not start. */
async function startedWorker(start: StartWorker): Promise<Worker | null> {
  // reason: a page without workers, or whose policy forbids them, throws or emits an error; both mean that none starts.
  const worker = await Promise.resolve()
    .then(start)
    .catch(() => null);
  if (!worker) return null;
  const runs = await new Promise<boolean>((resolve) => {
    const timer = setTimeout(() => resolve(false), patienceMs);
    const settle = (started: boolean) => () => {
      clearTimeout(timer);
      resolve(started);
    };
    worker.onmessage = settle(true);
    worker.onerror = settle(false);
  });
  if (runs) return worker;
  worker.terminate();
  return null;
}

/**
 * Returns a check that starts a worker for each file, so that a slow check delays no frame. The bytes are transferred:
 * the given buffer is empty afterwards. `instead`: the check if no worker starts.
 */
export const createWorkerCheck =
  (start: StartWorker, instead: AvatarCheck): AvatarCheck =>
  async (bytes, question) => {
    const worker = await startedWorker(start);
    return worker ? checkedBy(worker, bytes, question) : instead(bytes, question);
  };

function checkedBy(
  worker: Worker,
  bytes: ArrayBuffer,
  { name, supportedCompressions, limits }: Parameters<AvatarCheck>[1],
): Promise<CheckedAvatar> {
  return new Promise<CheckedAvatar>((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error(`${name}: the check took too long`)), patienceMs);
    worker.onmessage = ({ data: answer }: MessageEvent<AvatarCheckResponse>) => {
      clearTimeout(timer);
      if ('checked' in answer) resolve(answer.checked);
      else if ('motion' in answer) reject(new MotionOnlyError(name));
      else reject(new Error(answer.refused));
    };
    worker.onerror = ({ message }) => {
      clearTimeout(timer);
      reject(new Error(`${name}: could not be checked (${message || 'the validator stopped'})`));
    };
    const question: AvatarCheckRequest = { bytes, name, supportedCompressions, ...(limits && { limits }) };
    worker.postMessage(question, [bytes]);
  }).finally(() => worker.terminate());
}
