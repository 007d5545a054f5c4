import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { chromium, type Page } from '@playwright/test';
import { reportFigures } from '../../tests/reliability/report-figures';
import { drawSeldom } from '../draw-seldom';
import { collectErrors, expect, joinedRoom, probe } from '../page-fixture';
import { recordsOf, test } from '../study/study-participant';
import { experimenter, shortStudy } from '../study/study-server';

/**
 * A page of a browser whose user lets no site store anything: localStorage throws, IndexedDB and service workers are
 * refused.
 */
async function inClosedBrowser(origin: string, launch: object, body: (page: Page) => Promise<void>): Promise<void> {
  const profile = mkdtempSync(join(tmpdir(), 'threepoint-profile-'));
  mkdirSync(join(profile, 'Default'));
  const blocked = { profile: { default_content_setting_values: { cookies: 2 } } };
  writeFileSync(join(profile, 'Default/Preferences'), JSON.stringify(blocked));
  const context = await chromium.launchPersistentContext(profile, launch);
  try {
    await drawSeldom(context);
    const page = await context.newPage();
    await page.goto(`${origin}/withdraw`);
    const refused = await page.evaluate(() => {
      try {
        return String(window.localStorage);
      } catch (error) {
        return (error as Error).name;
      }
    });
    expect(refused, 'what this browser says of its storage').toBe('SecurityError');
    const { errors } = collectErrors(page, origin);
    await body(page);
    expect(errors).toEqual([]);
  } finally {
    await context.close();
    rmSync(profile, { recursive: true });
  }
}

test('a browser that stores nothing shows the page, plays with others and joins a study @full', async ({
  origin,
  launchOptions,
}) => {
  test.setTimeout(120_000);
  const study = shortStudy('denied');
  await experimenter(origin).addStudy(study, false);
  const link = await experimenter(origin).link('denied', 'P01', '&quality=low');
  await inClosedBrowser(origin, launchOptions, async (page) => {
    await page.goto(`${origin}/?quality=low&panel=off&overlay=off`);
    await page.waitForFunction(() => window.threepoint?.probe().ready, undefined, { timeout: 60_000 });
    const { estimator, notices } = await probe(page);
    expect(estimator).toBe('learned');
    expect(notices.map(({ text }) => text)).toEqual([
      'This browser does not let the page store anything, so calibration and settings are lost when you close it.',
    ]);

    await page.goto(`${origin}/?play=ball&room=denied&bots=off&panel=off&quality=low&estimator=ik&overlay=off`);
    await joinedRoom(page);

    await page.goto(link);
    await page.getByLabel(/I have read this/).check({ timeout: 30_000 });
    await page.getByRole('button', { name: 'I agree' }).click();
    await expect.poll(async () => (await recordsOf(origin, 'denied')).length).toBe(1);
    await page.getByRole('button', { name: 'I have noted it' }).click();
    await expect(page.getByLabel(/Age/)).toBeVisible();
    await expect(page.getByText('This browser does not let the page store anything')).toBeVisible();
  });
  reportFigures('storage-denied', { 'pages that failed': '0 of 3' });
});
