import { vi } from 'vitest';
import type { AvatarCheckRequest, AvatarCheckResponse } from '../../../src/threepoint/avatar/file/avatar-check-worker';
import { checkAvatar } from '../../../src/threepoint/avatar/file/check-avatar';

/** The check of files on this thread; files of these names are held up until they are let go. */
export function checkFilesHere(...held: readonly string[]) {
  const waiting = new Map<string, () => void>();
  class Here extends EventTarget {
    onmessage: ((event: MessageEvent<AvatarCheckResponse | 'ready'>) => void) | null = null;

    constructor() {
      super();
      setImmediate(() => this.#post('ready'));
    }
    postMessage({ bytes, ...question }: AvatarCheckRequest): void {
      const check = () => checkAvatar(bytes, question).then((checked) => this.#post({ checked }));
      if (held.includes(question.name)) waiting.set(question.name, check);
      else void check();
    }
    terminate(): void {
      // It ends with its only question.
    }
    #post(data: AvatarCheckResponse | 'ready'): void {
      this.onmessage?.(new MessageEvent('message', { data }));
    }
  }
  vi.stubGlobal('Worker', Here);
  return (name: string) => waiting.get(name)?.();
}
