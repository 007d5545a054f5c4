import { rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { test as base } from '@playwright/test';
import { build } from '../../scripts/build.mjs';
import { collectErrors, expect, keepPicture, newPage, probe } from '../page-fixture';
import { serveStatic } from '../static-server';

const dist = fileURLToPath(new URL('../../dist', import.meta.url));

/**
 * The page from a host that serves files out of a folder and nothing else. It may ask for nothing beyond that folder,
 * nor complain.
 */
const test = base.extend<{ built: string; address: string; complaints: readonly string[] }>({
  built: [dist, { option: true }],
  address: async ({ built }, use) => {
    const host = await serveStatic(built, '/threepoint/');
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

test.describe('built for one folder @full', () => {
  const out = join(tmpdir(), `threepoint-page-${process.pid}`);
  test.use({ built: out });
  test.beforeAll(async () => {
    test.setTimeout(240_000);
    await build({ base: '/threepoint/', out });
  });
  test.afterAll(() => rmSync(out, { recursive: true, force: true }));

  test('the page draws the learned body, and the study pages say in a sentence that there is no server @full', async ({
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
});
