import { reportFigures } from '../../tests/reliability/report-figures';
import { expect, joint, open, probe, freshTest as test } from '../page-fixture';

// Chromium without a graphics card computes WebGPU in software, and only when asked to.
test.use({
  launchOptions: async ({ launchOptions }, use) =>
    use({
      ...launchOptions,
      args: [...(launchOptions.args ?? []), '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader'],
    }),
});

interface LostDevice {
  destroy(): void;
}
interface Adapter {
  requestDevice(descriptor?: object): Promise<LostDevice>;
}

declare global {
  interface Window {
    /** The devices that the page was given, kept by the test to lose them. */
    graphicsDevices?: LostDevice[];
  }
}

test('@nightly a WebGPU device that is lost: WASM takes over, the network stays, the body never stops', async ({
  page,
  complaints,
}) => {
  test.setTimeout(240_000);
  complaints.allow(/webgpu|device|lost|destroy/i);
  await page.addInitScript(() => {
    const kept: LostDevice[] = [];
    window.graphicsDevices = kept;
    const { prototype } = (globalThis as unknown as { GPUAdapter: { prototype: Adapter } }).GPUAdapter;
    const { requestDevice } = prototype;
    prototype.requestDevice = async function (this: Adapter, descriptor?: object) {
      const device = await requestDevice.call(this, descriptor);
      kept.push(device);
      return device;
    };
  });
  await open(page, 'estimator=learned&ep=webgpu&panel=off&quality=low');
  await expect.poll(async () => (await probe(page)).provider, { timeout: 120_000 }).toBe('webgpu');
  const lost = await page.evaluate(
    () =>
      new Promise<{ ms: number; frames: number }>((resolve) => {
        const before = window.threepoint?.probe().frame.count ?? 0;
        const start = performance.now();
        for (const device of window.graphicsDevices ?? []) device.destroy();
        const look = () => {
          const shown = window.threepoint?.probe();
          if (shown?.provider === 'wasm')
            resolve({ ms: performance.now() - start, frames: shown.frame.count - before });
          else requestAnimationFrame(look);
        };
        look();
      }),
  );
  const { estimator } = await probe(page);
  expect(estimator).toBe('learned');
  expect((await joint(page, 'hips')).every(Number.isFinite)).toBe(true);
  expect(lost.frames, 'the body is drawn meanwhile').toBeGreaterThan(0);
  await expect(
    page
      .getByRole('alert')
      .filter({ hasText: /graphics device was lost/i })
      .first(),
  ).toBeVisible();
  reportFigures('webgpu-lost', {
    'WASM computes': `after ${Math.round(lost.ms)} ms, ${lost.frames} frames drawn meanwhile`,
  });
});
