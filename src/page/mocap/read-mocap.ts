import type { WorkOptions } from 'threepoint/api/run-work';
import type { PreparedMocap } from 'threepoint/core/mocap/prepare-mocap';
import { secondsLeft } from 'threepoint/core/motion/work';
import { fileNameOf } from 'threepoint-ui/limited-files';
import type { MocapFile, MocapFiles } from './mocap-files';
import type { MocapAnswer } from './mocap-worker';

/** Makes an address absolute for a worker, whose base address differs from the page's. */
const forWorker = (file: MocapFile): MocapFile => (typeof file === 'string' ? new URL(file, location.href).href : file);

/**
 * Reads motion capture in a worker that lives no longer than that, from the first byte on: neither a large file nor a
 * broken one touches the picture. Rejects with a sentence where the file is none, with the signal's reason where it is
 * given up.
 */
export function readMocap(
  { motion, skeleton, map }: MocapFiles,
  { onProgress, signal }: WorkOptions = {},
): Promise<PreparedMocap> {
  signal?.throwIfAborted();
  const worker = new Worker(new URL('./mocap-worker.ts', import.meta.url), { type: 'module' });
  const begun = performance.now();
  return new Promise<PreparedMocap>((resolve, reject) => {
    signal?.addEventListener('abort', () => reject(signal.reason));
    worker.addEventListener('message', ({ data: answer }: MessageEvent<MocapAnswer>) => {
      if ('prepared' in answer) resolve(answer.prepared);
      else if ('refused' in answer) reject(new Error(answer.refused));
      else {
        const { share: fraction } = answer;
        onProgress?.({ fraction, secondsLeft: secondsLeft(fraction, (performance.now() - begun) / 1000) });
      }
    });
    worker.addEventListener('error', ({ message }) => {
      reject(new Error(`${fileNameOf(motion)}: it could not be read (${message || 'its reader did not start'})`));
    });
    const files: MocapFiles = {
      motion: forWorker(motion),
      skeleton: skeleton && forWorker(skeleton),
      map: map && forWorker(map),
    };
    worker.postMessage(files);
  }).finally(() => worker.terminate());
}
