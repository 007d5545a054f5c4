import type { WorkOptions } from 'threepoint/api/run-work';
import { type FileBones, UnknownBonesError } from 'threepoint/core/humanoid/unknown-bones-error';
import type { PreparedMocap } from 'threepoint/core/mocap/prepare-mocap';
import { secondsLeft } from 'threepoint/core/motion/work';
import { fileNameOf } from 'threepoint-ui/limited-files';
import type { GivenBones, MocapFile, MocapFiles } from './mocap-files';
import type { MocapAnswer, MocapQuestion, MotionMap } from './mocap-worker';

/** Makes an address absolute for a worker, whose base address differs from the page's. */
const forWorker = (file: MocapFile): MocapFile => (typeof file === 'string' ? new URL(file, location.href).href : file);

/** The error of a motion whose bones match no humanoid: a map of them can be given, and kept by the file's hash. */
export class UnmatchedMotion extends UnknownBonesError {
  constructor(
    message: string,
    bones: FileBones,
    readonly hash: string | null,
  ) {
    super(message, bones);
  }
}

/** The motion of files, and the user's map of their bones. */
export interface ReadMocap {
  readonly prepared: PreparedMocap;
  readonly map: MotionMap;
}

/**
 * Reads motion capture in a worker that lives no longer than that, from the first byte on: neither a large file nor a
 * broken one touches the picture. Rejects with a sentence where the file is none, with UnmatchedMotion where its bones
 * match no humanoid, with the signal's reason where it is given up.
 */
export function readMocap(
  { motion, skeleton, map }: MocapFiles,
  given: GivenBones,
  { onProgress, signal }: WorkOptions = {},
): Promise<ReadMocap> {
  signal?.throwIfAborted();
  const worker = new Worker(new URL('./mocap-worker.ts', import.meta.url), { type: 'module' });
  const begun = performance.now();
  return new Promise<ReadMocap>((resolve, reject) => {
    signal?.addEventListener('abort', () => reject(signal.reason));
    worker.addEventListener('message', ({ data: answer }: MessageEvent<MocapAnswer>) => {
      if ('prepared' in answer) resolve(answer);
      else if ('refused' in answer) {
        const { refused, bones, hash } = answer;
        reject(bones ? new UnmatchedMotion(refused, bones, hash) : new Error(refused));
      } else {
        const { share: fraction } = answer;
        onProgress?.({ fraction, secondsLeft: secondsLeft(fraction, (performance.now() - begun) / 1000) });
      }
    });
    worker.addEventListener('error', ({ message }) => {
      reject(new Error(`${fileNameOf(motion)}: it could not be read (${message || 'its reader did not start'})`));
    });
    const question: MocapQuestion = {
      ...given,
      motion: forWorker(motion),
      skeleton: skeleton && forWorker(skeleton),
      map: map && forWorker(map),
    };
    worker.postMessage(question);
  }).finally(() => worker.terminate());
}
