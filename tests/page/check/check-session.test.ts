import type { WebGLRenderer } from 'three';
import { expect, test, vi } from 'vitest';
import { enterSession } from '../../../src/page/check/check-session';

class Session extends EventTarget {
  readonly inputSources = [];
  ended = false;

  async end(): Promise<void> {
    if (this.ended) throw new DOMException('The session has ended already', 'InvalidStateError');
    this.ended = true;
    this.dispatchEvent(new Event('end'));
  }
}

test('a session without a floor is refused with a sentence, and ended', async () => {
  const session = new Session();
  const xr = { setSession: async () => undefined, getReferenceSpace: () => null };
  vi.stubGlobal('navigator', { xr: { requestSession: async () => session } });
  const entering = enterSession({ xr } as unknown as WebGLRenderer);
  await expect(entering).rejects.toThrow('no floor-level reference space');
  expect(session.ended).toBe(true);
});
