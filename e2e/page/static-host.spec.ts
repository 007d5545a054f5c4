import { rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test as base } from '@playwright/test';
import { build } from '../../scripts/build.mjs';
import { collectErrors, expect, keepPicture, newPage, probe } from '../page-fixture';
import { serveStatic } from '../static-server';

const out = join(tmpdir(), `threepoint-page-${process.pid}`);

/**
 * The page, built for one folder, from a host that serves the files of that folder and nothing else. The page may
 * request nothing beyond that folder and report no error.
 */
const test = base.extend<{ address: string; complaints: readonly string[] }>({
  // biome-ignore lint/correctness/noEmptyPattern: Playwright reads the fixture's needs from this pattern
  address: async ({}, use) => {
    const host = await serveStatic(out, '/threepoint/');
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
      const { errors, stop } = collectErrors(page, address);
      await use(errors);
      stop();
      expect(errors, 'complaints of the page').toEqual([]);
    },
    { auto: true },
  ],
});

test.beforeAll(async () => {
  test.setTimeout(240_000);
  await build({ base: '/threepoint/', out });
});
test.afterAll(() => rmSync(out, { recursive: true, force: true }));

test('the licences of the packages in pages, workers and the service worker lie beside the page @full', async ({
  page,
}) => {
  const text = await (await page.request.get('licences.txt')).text();
  for (const name of ['three', 'onnxruntime-web', 'gltf-validator', 'workbox-precaching', 'iwer'])
    expect(text).toMatch(new RegExp(`^${name} \\d`, 'm'));
});

test('the page draws the learned body, and the study pages say that there is no server @full', async ({
  page,
  address,
}) => {
  await page.goto('?quality=low&panel=off');
  await page.waitForFunction(() => window.threepoint?.probe().ready, undefined, { timeout: 60_000 });
  const { estimator, notices } = await probe(page);
  expect({ estimator, notices }).toEqual({ estimator: 'learned', notices: [] });
  for (const [file, link] of [
    ['results.html', 'experimenter.html'],
    ['experimenter.html', 'results.html'],
  ]) {
    await page.goto(file as string);
    await expect(page.getByText('Studies need a threepoint server')).toBeVisible();
    const hrefs = await page
      .locator('nav a')
      .evaluateAll((links) => links.map((each) => (each as HTMLAnchorElement).href));
    expect(hrefs).toEqual([address + link, address]);
  }
  await keepPicture(page, 'static-host-experimenter');
});

test('a link to a room opens one’s own court @full', async ({ page }) => {
  await page.goto('?play=ball&room=friends&quality=low&panel=off');
  await page.waitForFunction(() => window.threepoint?.probe().game, undefined, { timeout: 60_000 });
  await expect(page.getByText('Your own room')).toBeVisible();
  await expect(page.getByText('host has no threepoint server')).toBeVisible();
  await expect(page.getByRole('button', { name: 'Play with others' })).toBeHidden();
  await keepPicture(page, 'static-host-rooms');
});
