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

/** A device whose renderer draws a session by `draw`, in a space with a floor or in none. */
function device(draw: () => Promise<void>, hasFloor = true) {
  const session = new Session();
  const space = hasFloor ? new EventTarget() : null;
  const xr = { setSession: draw, getReferenceSpace: () => space, setReferenceSpace: () => undefined };
  vi.stubGlobal('navigator', { xr: { requestSession: async () => session } });
  return { session, entering: enterSession({ xr } as unknown as WebGLRenderer) };
}

test('a session that is drawn is entered', async () => {
  const { session, entering } = device(async () => undefined);
  expect(await entering).toBe(session);
  expect(session.ended).toBe(false);
});

test('a session that ends before it is drawn is refused with a sentence', async () => {
  let { session, entering } = {} as ReturnType<typeof device>;
  // A renderer whose device has gone never answers.
  await new Promise<void>((drawn) => {
    ({ session, entering } = device(() => {
      drawn();
      return new Promise(() => undefined);
    }));
  });
  await session.end();
  await expect(entering).rejects.toThrow('ended before it had begun');
});

test('a session without a floor is refused with a sentence, and ended', async () => {
  const { session, entering } = device(async () => undefined, false);
  await expect(entering).rejects.toThrow('no floor-level reference space');
  expect(session.ended).toBe(true);
});

test('a session that cannot be drawn is ended, and the renderer’s reason stays', async () => {
  const { session, entering } = device(() => Promise.reject(new Error('no such graphics device')));
  await expect(entering).rejects.toThrow('no such graphics device');
  expect(session.ended).toBe(true);
});
