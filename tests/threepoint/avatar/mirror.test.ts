import { PerspectiveCamera, Scene, SRGBColorSpace, type Vector2, Vector3, type WebGLRenderTarget } from 'three';
import { describe, expect, test } from 'vitest';
import { FramePacer, Mirror } from '../../../src/threepoint/avatar/mirror';

/** A picture of this size [pixels], as a renderer without a graphics device has it. */
function pictureOf(width: number, height: number) {
  const targets: WebGLRenderTarget[] = [];
  const renderer = {
    xr: { enabled: true, isPresenting: false },
    info: { render: { frame: 0 } },
    shadowMap: { autoUpdate: true },
    state: { buffers: { depth: { setMask: () => undefined } } },
    autoClear: true,
    outputColorSpace: SRGBColorSpace,
    getDrawingBufferSize: (size: Vector2) => size.set(width, height),
    getRenderTarget: () => null,
    setRenderTarget: (target: WebGLRenderTarget | null) => target && targets.push(target),
    render: () => undefined,
  };
  const camera = new PerspectiveCamera(42, width / height, 0.05, 90);
  camera.position.set(0.4, 1.5, 2);
  camera.lookAt(0, 1.2, -1.4);
  return {
    camera,
    /** Returns the target into which the reflection was drawn. */
    reflect(mirror: Mirror): WebGLRenderTarget {
      mirror.reflect(renderer as never, new Scene(), camera, 0);
      return targets.at(-1)!;
    },
  };
}

describe('the reflection of a mirror', () => {
  test.each([
    [1280, 720],
    [845, 475],
    [780, 1688],
  ])('has the pixels of a picture of %i × %i', (width, height) => {
    const target = pictureOf(width, height).reflect(new Mirror({ width: 3.6, height: 2.4, distance: 1.4 }));
    expect([target.width, target.height]).toEqual([width, height]);
  });

  test('is no wider than it was asked to be, however large the picture is', () => {
    const target = pictureOf(4000, 2000).reflect(new Mirror({ resolution: 1024 }));
    expect([target.width, target.height]).toEqual([1024, 512]);
  });

  test('is drawn only where the glass is, left and right exchanged', () => {
    const picture = pictureOf(1280, 720);
    const { scissorTest, scissor, width } = picture.reflect(new Mirror({ distance: 1.4 }));
    expect(scissorTest).toBe(true);
    const edges = [-0.75, 0.75].map((x) => new Vector3(x, 1.2, -1.4).project(picture.camera).x);
    const exchanged = edges.map((across) => ((1 - across) / 2) * width).sort((a, b) => a - b);
    expect(scissor.x).toBeLessThanOrEqual(exchanged[0]!);
    expect(scissor.x + scissor.z).toBeGreaterThanOrEqual(exchanged[1]!);
    expect(scissor.z).toBeLessThan(0.6 * width);
  });
});

describe('the pace of reflections', () => {
  /** Returns how many frames of ten seconds at a rate are due, and the longest wait between two of them [s]. */
  function tenSeconds(pace: FramePacer, frameHz: number): { readonly due: number; readonly longest: number } {
    let due = 0;
    let last = 0;
    let longest = 0;
    for (let i = 0; i < 10 * frameHz; i++) {
      // A device's frames come a little early and late.
      const time = i / frameHz + 0.0004 * Math.sin(7 * i);
      if (!pace.isDue(time)) continue;
      due += 1;
      longest = Math.max(longest, time - last);
      last = time;
    }
    return { due, longest };
  }

  test.each([72, 80, 90, 120])('is 36 a second in frames of %i Hz', (frameHz) => {
    const pace = new FramePacer();
    pace.rateHz = 36;
    const { due, longest } = tenSeconds(pace, frameHz);
    expect(due).toBeGreaterThanOrEqual(355);
    expect(due).toBeLessThanOrEqual(361);
    expect(longest).toBeLessThan(1 / 36 + 1 / frameHz + 0.001);
  });

  test('is that of the frames where they are slower, or where it has no bound', () => {
    const pace = new FramePacer();
    expect(tenSeconds(pace, 72).due).toBe(720);
    pace.rateHz = 36;
    expect(tenSeconds(pace, 30).due).toBe(300);
  });

  test('starts at once after a pause, a restart and a clock that was set back', () => {
    const pace = new FramePacer();
    pace.rateHz = 36;
    expect(pace.isDue(100)).toBe(true);
    expect(pace.isDue(100.01)).toBe(false);
    expect(pace.isDue(160)).toBe(true);
    expect(pace.isDue(160.01)).toBe(false);
    expect(pace.isDue(3)).toBe(true);
    pace.restart();
    expect(pace.isDue(3.01)).toBe(true);
  });
});
