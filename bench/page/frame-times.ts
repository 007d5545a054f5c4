import type { WebGLRenderer } from 'three';
import { median } from 'threepoint/math';
import { mean, quantile } from '../../src/threepoint/core/math/statistics';

/** Resolves in the next animation frame. */
export const nextFrame = (): Promise<number> => new Promise((resolve) => requestAnimationFrame(resolve));

const pixel = new Uint8Array(4);

/** Does the work of the next animation frame; resolves to its time [ms] on the page's thread, and until it is drawn. */
export async function timeFrame(renderer: WebGLRenderer, work: () => void) {
  await nextFrame();
  const started = performance.now();
  work();
  const thread = performance.now() - started;
  // Commands are only queued so far: asking for a pixel waits until all of them are drawn.
  const gl = renderer.getContext();
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  return { thread, drawn: performance.now() - started };
}

/** Frame times [ms]; missed: share of frames too late for that rate. */
export interface FrameTimes {
  readonly min: number;
  readonly mean: number;
  readonly p50: number;
  readonly p95: number;
  readonly max: number;
  /** On the page's own thread, at 72 and 90 Hz: what a headset with graphics of its own would miss. */
  readonly missed72: number;
  readonly missed90: number;
  /** Frame times up to the drawn frame, in software. */
  readonly drawnP50: number;
  readonly drawnP95: number;
  readonly drawnMissed72: number;
  readonly frames: number;
}

export function frameTimes(thread: readonly number[], drawn: readonly number[], frames: number): FrameTimes {
  const missed = (values: readonly number[], hz: number) =>
    values.filter((ms) => ms > 1000 / hz).length / values.length;
  const round = (value: number) => Number(value.toFixed(4));
  return {
    min: round(quantile(thread, 0)),
    mean: round(mean(thread)),
    p50: round(median(thread)),
    p95: round(quantile(thread, 0.95)),
    max: round(quantile(thread, 1)),
    missed72: round(missed(thread, 72)),
    missed90: round(missed(thread, 90)),
    drawnP50: round(median(drawn)),
    drawnP95: round(quantile(drawn, 0.95)),
    drawnMissed72: round(missed(drawn, 72)),
    frames,
  };
}
