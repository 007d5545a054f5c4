import type { Page } from '@playwright/test';
import { reportFigures } from '../../tests/reliability/report-figures';
import { enterVr, expect, joint, openWithHeadset, probe, freshTest as test } from '../page-fixture';

/** How long after the page's script the first body was drawn [s]. */
const firstBody = (page: Page): Promise<number> =>
  page.evaluate(() => {
    const { script = 0, firstBody = Number.NaN } = window.threepoint?.probe().loading ?? {};
    return (firstBody - script) / 1000;
  });

test('a model that is missing: IK takes over and the page says so', async ({ page, complaints }) => {
  complaints.allow(/learned/, /404/);
  await page.route('**/models/learned.bin', (route) => route.fulfill({ status: 404, body: 'Not found.' }));
  const headset = await openWithHeadset(page, 'estimator=learned');
  await expect.poll(async () => (await probe(page)).estimator).toBe('ik');
  await expect(page.getByRole('alert').filter({ hasText: /IK|inverse kinematics/i })).toBeVisible();
  await enterVr(page);
  await headset.place({ head: { position: [0.3, 1.6, 0] } });
  await expect.poll(async () => Math.abs((await joint(page, 'head'))[0] - 0.3)).toBeLessThan(0.05);
});

test('without WebAssembly the learned network runs, and IK takes the place of the paper’s', async ({
  page,
  complaints,
}) => {
  complaints.allow(/wasm/i, /404/, /paper/);
  let answer: () => void = () => undefined;
  const answered = new Promise<void>((resolve) => {
    answer = resolve;
  });
  await page.route('**/*.wasm', async (route) => {
    await answered;
    await route.fulfill({ status: 404, body: 'Not found.' });
  });
  // The page calls itself ready once it knows of WASM; its body must not wait so long.
  const ready = openWithHeadset(page, 'estimator=paper');
  await page.waitForFunction(() => window.threepoint?.probe().loading.firstBody !== undefined);
  answer();
  await ready;
  reportFigures('no-wasm', {
    'body drawn by IK': `${(await firstBody(page)).toFixed(2)} s after the page's script began`,
  });
  await expect.poll(async () => (await probe(page)).estimator).toBe('ik');
  await expect(page.getByRole('alert').filter({ hasText: /IK|inverse kinematics/i })).toBeVisible();

  await openWithHeadset(page, 'estimator=learned');
  const { estimator, provider } = await probe(page);
  expect({ estimator, provider }).toEqual({ estimator: 'learned', provider: 'plain' });
});

test('without the worker that runs networks IK takes over and the page says so @full', async ({ page, complaints }) => {
  complaints.allow(/worker/i, /404/, /learned|paper/);
  await page.route('**/inference-worker*.js', (route) => route.fulfill({ status: 404, body: 'Not found.' }));
  await openWithHeadset(page, 'estimator=learned');
  await expect.poll(async () => (await probe(page)).estimator).toBe('ik');
  await expect(page.getByRole('alert').filter({ hasText: /IK|inverse kinematics/i })).toBeVisible();
});

test('a worker that dies while the network runs: IK takes over and the page says so @full', async ({
  page,
  complaints,
}) => {
  complaints.allow(/worker/i, /learned/);
  await openWithHeadset(page, 'estimator=learned&actor=on');
  await expect.poll(async () => (await probe(page)).estimator).toBe('learned');
  const worker = page.workers().find((each) => each.url().includes('inference-worker'));
  await worker?.evaluate(() => self.close());
  await expect.poll(async () => (await probe(page)).estimator).toBe('ik');
  await expect(page.getByRole('alert').filter({ hasText: /does not answer/ })).toBeVisible();
});

test('WASM replaces a WebGPU that is missing; the network stays, and the page says so @full', async ({
  page,
  complaints,
}) => {
  complaints.allow(/webgpu/i);
  await page.addInitScript(() => Object.defineProperty(Navigator.prototype, 'gpu', { get: () => undefined }));
  await openWithHeadset(page, 'estimator=learned&ep=webgpu');
  await expect.poll(async () => (await probe(page)).provider).toBe('wasm');
  expect((await probe(page)).estimator).toBe('learned');
  await expect(page.getByRole('alert').filter({ hasText: /WebGPU/i })).toBeVisible();
});
