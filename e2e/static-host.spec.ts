import { fileURLToPath } from 'node:url';
import { test as base } from '@playwright/test';
import type { ArcheryProbe } from '../src/app/archery/archery-play';
import { holdAt } from './driven-time';
import { emulatedHeadset } from './emulated-headset';
import { enterVr, expect, joint, keepPicture, listen, newPage, probe } from './page-fixture';
import { servePlainly } from './plain-server';

const dist = fileURLToPath(new URL('../dist', import.meta.url));

/** The page from a host that serves files out of a folder and nothing else. It may ask for nothing beyond that folder, nor complain. */
const test = base.extend<{ address: string; complaints: readonly string[] }>({
  // biome-ignore lint/correctness/noEmptyPattern: Playwright reads the fixture's needs from this pattern
  address: async ({}, use) => {
    const host = await servePlainly(dist, '/threepoint/');
    await use(host.address);
    await host.close();
  },
  page: async ({ browser, address }, use) => {
    const page = await newPage(browser, address);
    await page.setViewportSize({ width: 960, height: 600 });
    await use(page);
    await page.context().close();
  },
  complaints: [
    async ({ page, address }, use) => {
      const { heard, stop } = listen(page, address);
      await use(heard);
      stop();
      expect(heard, 'complaints of the page').toEqual([]);
    },
    { auto: true },
  ],
});

test('from a folder of a host of files: the learned body in VR, archery, and a sentence where rooms would be', async ({
  page,
}) => {
  await page.goto('?emulate&play=archery&seed=7&panel=off&quality=low');
  await page.waitForFunction(() => window.threepoint?.probe().ready, undefined, { timeout: 60_000 });
  const headset = await emulatedHeadset(page);
  await enterVr(page);
  await holdAt<ArcheryProbe>(page, { stage: 'drawing' });
  const { estimator, provider, notices } = await probe(page);
  expect({ estimator, provider, notices }).toEqual({ estimator: 'learned', provider: 'wasm', notices: [] });
  expect(await joint(page, 'rightLowerArm')).toHaveLength(3);
  await holdAt<ArcheryProbe>(page, { score: 5 });
  await keepPicture(page, 'static-host-archery');
  await headset.endSession();

  await page.getByRole('button', { name: 'Ball game' }).click();
  await expect(page.getByText('comes from a host without a threepoint server')).toBeVisible();
  await expect(page.getByRole('button', { name: 'Play with others' })).toBeHidden();
  await keepPicture(page, 'static-host-rooms');
});
