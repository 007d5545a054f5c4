import { reasonOf } from '../../core/errors/reasons';
import { type AvatarCheckOptions, type CheckedAvatar, checkAvatar } from './check-avatar';
import { MotionOnlyError } from './motion-only-error';

export interface AvatarCheckRequest extends AvatarCheckOptions {
  readonly bytes: ArrayBuffer;
}

/** The response to a check: the checked file, the reason for refusing it, or that it contains only motion. */
export type AvatarCheckResponse =
  | { readonly checked: CheckedAvatar }
  | { readonly refused: string }
  | { readonly motion: true };

self.addEventListener('message', ({ data: { bytes, ...question } }: MessageEvent<AvatarCheckRequest>) => {
  checkAvatar(bytes, question).then(
    (checked) => self.postMessage({ checked } satisfies AvatarCheckResponse),
    (error: unknown) =>
      self.postMessage(
        (error instanceof MotionOnlyError
          ? { motion: true }
          : { refused: reasonOf(error) }) satisfies AvatarCheckResponse,
      ),
  );
});
// The first message reports that the worker runs.
self.postMessage('ready');
