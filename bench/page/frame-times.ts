import type { WebGLRenderer } from 'three';

/** Resolves in the next animation frame. */
export const nextFrame = (): Promise<number> => new Promise((resolve) => requestAnimationFrame(resolve));

const pixel = new Uint8Array(4);

/** Does the work of the next animation frame and waits until it is drawn. */
export async function drawFrame(renderer: WebGLRenderer, work: () => void): Promise<void> {
  await nextFrame();
  work();
  // Commands are only queued so far: asking for a pixel waits until all of them are drawn.
  const gl = renderer.getContext();
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
}
