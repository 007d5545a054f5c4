import type { PreparedMocap } from '../../core/mocap/prepare-mocap';
import { secondsLeft } from '../../core/motion/work';
import type { WorkOptions } from '../../lib/run-work';
import type { MocapFiles } from './mocap-files';
import type { MocapAnswer } from './mocap-worker';

/**
 * Reads motion capture in a worker that lives no longer than that: neither a large file nor a broken one touches the picture. Rejects with a
 * sentence where the file is none, with the signal's reason where it is given up.
 */
export function readMocap(files: MocapFiles, { onProgress, signal }: WorkOptions = {}): Promise<PreparedMocap> {
  signal?.throwIfAborted();
  const worker = new Worker(new URL('./mocap-worker.ts', import.meta.url), { type: 'module' });
  const begun = performance.now();
  return new Promise<PreparedMocap>((resolve, reject) => {
    signal?.addEventListener('abort', () => reject(signal.reason));
    worker.addEventListener('message', ({ data: answer }: MessageEvent<MocapAnswer>) => {
      if ('prepared' in answer) resolve(answer.prepared);
      else if ('refused' in answer) reject(new Error(answer.refused));
      else {
        const { share } = answer;
        onProgress?.({ share, secondsLeft: secondsLeft(share, (performance.now() - begun) / 1000) });
      }
    });
    worker.addEventListener('error', ({ message }) => {
      reject(new Error(`${files.motion.name}: it cannot be read (${message || 'its reader did not start'})`));
    });
    const { motion, skeleton } = files;
    worker.postMessage(files, [motion.bytes, ...(skeleton ? [skeleton.bytes] : [])]);
  }).finally(() => worker.terminate());
}
