import { type FileBones, UnknownBonesError } from 'threepoint/core';
import { type PreparedMocap, secondsLeft } from 'threepoint/internal';
import type { WorkOptions } from 'threepoint/motion';
import { fileNameOf } from 'threepoint-ui';
import type { GivenBones, MocapFile, MocapFiles } from './mocap-files';
import type { MocapRequest, MocapResponse, MotionMap } from './mocap-worker';

/** Makes an address absolute for a worker, whose base address differs from the page's. */
const forWorker = (file: MocapFile): MocapFile => (typeof file === 'string' ? new URL(file, location.href).href : file);

/** The error of a motion whose bones match no humanoid. `hash`: of the file, by which the user's map is stored. */
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
 * Reads motion capture in a worker, which ends with it, so that the page continues to draw. Rejects with a sentence if
 * a file is invalid, with UnmatchedMotion if its bones match no humanoid, with the signal's reason if it is aborted.
 */
export function readMocap(
  { motion, skeleton, map }: MocapFiles,
  given: GivenBones,
  { onProgress, signal }: WorkOptions = {},
): Promise<ReadMocap> {
  signal?.throwIfAborted();
  const worker = new Worker(new URL('./mocap-worker.ts', import.meta.url), { type: 'module' });
  const startMs = performance.now();
  return new Promise<ReadMocap>((resolve, reject) => {
    signal?.addEventListener('abort', () => reject(signal.reason));
    worker.addEventListener('message', ({ data: response }: MessageEvent<MocapResponse>) => {
      if ('prepared' in response) resolve(response);
      else if ('failure' in response) {
        const { failure, bones, hash } = response;
        reject(bones ? new UnmatchedMotion(failure, bones, hash) : new Error(failure));
      } else {
        const { fraction } = response;
        onProgress?.({ fraction, secondsLeft: secondsLeft(fraction, (performance.now() - startMs) / 1000) });
      }
    });
    worker.addEventListener('error', ({ message }) => {
      reject(new Error(`${fileNameOf(motion)}: it could not be read (${message || 'its reader did not start'})`));
    });
    const request: MocapRequest = {
      ...given,
      motion: forWorker(motion),
      skeleton: skeleton && forWorker(skeleton),
      map: map && forWorker(map),
    };
    worker.postMessage(request);
  }).finally(() => worker.terminate());
}
