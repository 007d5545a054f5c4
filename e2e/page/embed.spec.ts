import { readFileSync } from 'node:fs';
import AxeBuilder from '@axe-core/playwright';
import type { Page } from '@playwright/test';
import { drawEveryFrame } from '../draw-seldom';
import { expect, keepPicture, freshTest as test } from '../page-fixture';

const source = readFileSync(new URL('../../src/page/embed/body.ts', import.meta.url), 'utf8').trim();

/** The most that the scripts of the page may have as they travel [kB]. */
const largestScripts = 290;

/** Returns how much of the canvas the body covers, and a sum of its colours that changes as it moves. */
const drawn = (page: Page) =>
  page.locator('canvas').evaluate(async (canvas: HTMLCanvasElement) => {
    const small = document.createElement('canvas');
    [small.width, small.height] = [90, 120];
    const context = small.getContext('2d')!;
    await new Promise(requestAnimationFrame);
    context.drawImage(canvas, 0, 0, small.width, small.height);
    const { data } = context.getImageData(0, 0, small.width, small.height);
    let [covered, sum] = [0, 0];
    for (let at = 0; at < data.length; at += 4) {
      if (data[at + 3]! > 128) covered += 1;
      sum += (at % 997) * (data[at]! + data[at + 1]!);
    }
    return { covered: covered / (data.length / 4), sum };
  });

test('the page to embed runs the program that it shows, with scripts of 290 kB', async ({ page }) => {
  const scripts: Promise<number>[] = [];
  page.on('response', (response) => {
    if (response.request().resourceType() === 'script')
      scripts.push(
        response
          .request()
          .sizes()
          .then(({ responseBodySize }) => responseBodySize),
      );
  });
  await page.goto('/embed');
  await drawEveryFrame(page);
  await expect(page.getByRole('region', { name: 'body.ts' }).locator('code')).toHaveText(source);
  expect(source.split('\n').filter((line) => line.trim() !== '').length).toBeLessThan(25);
  await expect.poll(async () => (await drawn(page)).covered, { timeout: 60_000 }).toBeGreaterThan(0.08);
  expect((await drawn(page)).covered).toBeLessThan(0.5);
  const { sum } = await drawn(page);
  expect(sum).toBeGreaterThan(0);
  await expect.poll(async () => (await drawn(page)).sum).not.toBe(sum);
  const bytes = (await Promise.all(scripts)).reduce((total, size) => total + size, 0);
  expect(bytes / 1000).toBeLessThan(largestScripts);
  await page.setViewportSize({ width: 1280, height: 720 });
  await keepPicture(page, 'embed');
  await page.setViewportSize({ width: 390, height: 844 });
  await keepPicture(page, 'embed-phone');
  const { violations } = await new AxeBuilder({ page }).analyze();
  expect(violations.map(({ id, nodes }) => [id, nodes.map(({ target }) => target.join(' '))])).toEqual([]);
});

test('the page to embed says why no body is there', async ({ page, complaints }) => {
  complaints.allow(/404/);
  await page.route('**/avatars/woman.vrm', (route) => route.fulfill({ status: 404 }));
  await page.goto('/embed');
  await expect(page.getByText('The body could not be shown: woman.vrm: the server answers 404')).toBeVisible();
  await expect(page.locator('code')).toHaveText(source);
});
