import { reasonOf } from '../../core/errors/reasons';
import { type AvatarQuestion, type CheckedAvatar, checkAvatar } from './check-avatar';
import { MotionWithoutBody } from './motion-only-error';

export interface WorkerQuestion extends AvatarQuestion {
  readonly bytes: ArrayBuffer;
}

/**
 * What comes back for a file: its bytes and what is known of them, the sentence that refuses it, or that it is motion.
 */
export type WorkerAnswer =
  | { readonly checked: CheckedAvatar }
  | { readonly refused: string }
  | { readonly motion: true };

self.addEventListener('message', ({ data: { bytes, ...question } }: MessageEvent<WorkerQuestion>) => {
  checkAvatar(bytes, question).then(
    (checked) => self.postMessage({ checked } satisfies WorkerAnswer, { transfer: [checked.bytes] }),
    (error: unknown) =>
      self.postMessage(
        (error instanceof MotionWithoutBody ? { motion: true } : { refused: reasonOf(error) }) satisfies WorkerAnswer,
      ),
  );
});
// The first message reports that the worker runs.
self.postMessage('ready');
