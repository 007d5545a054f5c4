import { reasonOf } from '../../core/errors/reasons';
import { type AvatarQuestion, type CheckedAvatar, checkAvatar } from './check-avatar';

export interface WorkerQuestion extends AvatarQuestion {
  readonly bytes: ArrayBuffer;
}

/** The answer to a file: its bytes and what is known of them, or the sentence that refuses it. */
export type WorkerAnswer = { readonly checked: CheckedAvatar } | { readonly refused: string };

self.addEventListener('message', ({ data: { bytes, ...question } }: MessageEvent<WorkerQuestion>) => {
  checkAvatar(bytes, question).then(
    (checked) => self.postMessage({ checked } satisfies WorkerAnswer, { transfer: [checked.bytes] }),
    (error: unknown) => self.postMessage({ refused: reasonOf(error) } satisfies WorkerAnswer),
  );
});
// The first message reports that the worker runs.
self.postMessage('ready');
