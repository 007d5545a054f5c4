import AxeBuilder from '@axe-core/playwright';
import type { Page } from '@playwright/test';
import { drawSeldom } from '../draw-seldom';
import { expect, keepPicture } from '../page-fixture';
import { continueAtDesk, signIn, test } from '../study/study-participant';
import { experimenter, shippedPlan, shortStudy } from '../study/study-server';

/** The sizes of a desk and of a phone [CSS pixels]. */
const sizes = [
  [1280, 720],
  [390, 844],
] as const;

/** The stage as the background at its worst: text on translucent panels must be readable over any picture. */
const overPicture = (color: string) => `#stage { display: none } html, body { background: ${color} !important }`;

/** Returns axe's complaints about the page as it is now. */
async function complaintsOf(page: Page): Promise<readonly string[]> {
  const { violations } = await new AxeBuilder({ page }).analyze();
  return violations.flatMap(({ id, nodes }) =>
    nodes.map(({ target, failureSummary }) => `${id} at ${target.join(' ')}: ${failureSummary?.split('\n').at(-1)}`),
  );
}

/** Adds axe's complaints about a view in both schemes and sizes to `found`, and saves its pictures. */
async function look(page: Page, view: string, found: string[], backgrounds: readonly string[] = []): Promise<void> {
  for (const [width, height] of sizes) {
    await page.setViewportSize({ width, height });
    for (const colorScheme of ['light', 'dark'] as const) {
      await page.emulateMedia({ colorScheme, reducedMotion: 'reduce' });
      const where = `${view}-${colorScheme}-${width}`;
      await keepPicture(page, `schemes/${where}`);
      for (const background of backgrounds) {
        const style = await page.addStyleTag({ content: overPicture(background) });
        for (const complaint of await complaintsOf(page)) found.push(`${where} over ${background}: ${complaint}`);
        await style.evaluate((element: Element) => element.remove());
      }
      if (backgrounds.length === 0)
        for (const complaint of await complaintsOf(page)) found.push(`${where}: ${complaint}`);
    }
  }
}

/** Every picture is between these. */
const pictures = ['black', 'white'];

test('axe finds nothing in either colour scheme at the mirror, its controls or the games @full', async ({ page }) => {
  test.setTimeout(240_000);
  await drawSeldom(page, 3_600_000);
  const found: string[] = [];
  const open = async (query: string) => {
    await page.goto(`/?quality=low&estimator=ik${query}`);
    await page.waitForFunction(() => window.threepoint?.probe().ready === true, undefined, { timeout: 60_000 });
  };
  await open('&panel=on');
  await look(page, 'mirror', found, pictures);
  for (const tab of ['Avatar', 'Recording', 'View']) {
    await page.getByRole('tab', { name: tab }).click();
    await look(page, tab.toLowerCase(), found, pictures);
  }
  for (const play of ['archery', 'ball']) {
    await open(`&play=${play}&panel=off&seed=5`);
    await expect(page.locator('#play .round:not([hidden])')).toBeVisible({ timeout: 60_000 });
    await look(page, play, found, pictures);
  }
  expect(found).toEqual([]);
});

test('axe finds nothing in either colour scheme on the pages of a study @full', async ({ page, origin }) => {
  test.setTimeout(240_000);
  const found: string[] = [];
  await page.goto(`${origin}/withdraw`);
  await look(page, 'withdraw', found);
  const plan = shippedPlan('latency', 'seen');
  await experimenter(origin).addStudy(plan, false);
  await page.goto(`${origin}/experimenter`);
  await look(page, 'sign-in', found);
  await signIn(page);
  await look(page, 'new-study', found);
  const choose = (id: string) => page.getByRole('combobox', { name: 'Study' }).selectOption(id);
  await choose('seen');
  await look(page, 'experimenter', found);
  await page.getByRole('button', { name: 'Simulate …' }).click();
  await look(page, 'simulate', found);
  await page.getByRole('dialog').getByRole('button', { name: 'Simulate' }).click();
  await expect(page.getByRole('status')).toContainText('can be opened now', { timeout: 60_000 });
  await page.goto(`${origin}/results`);
  await choose('seen-simulated');
  await expect(page.getByRole('img').first()).toBeVisible();
  await look(page, 'results', found);
  expect(found).toEqual([]);
});

test('axe finds nothing in either colour scheme on the check and at an unknown address @full', async ({
  page,
  origin,
  complaints,
}) => {
  complaints.allow(/404/);
  const found: string[] = [];
  for (const view of ['check', 'nowhere']) {
    await page.goto(`${origin}/${view}`);
    await look(page, view, found);
  }
  expect(found).toEqual([]);
});

test('axe finds nothing in either colour scheme on a participant’s cards @full', async ({ page, origin }) => {
  test.setTimeout(240_000);
  await drawSeldom(page, 3_600_000);
  const found: string[] = [];
  const plan = shortStudy('cards');
  await experimenter(origin).addStudy(plan, false);
  await page.goto(`${origin}/?study=cards&quality=low`);
  await expect(page.getByLabel('Code', { exact: false }).first()).toBeVisible({ timeout: 60_000 });
  await look(page, 'entrance', found, pictures);
  await page.goto(await experimenter(origin).link('cards', 'P02', '&quality=low'));
  await expect(page.getByRole('button', { name: 'I agree' })).toBeVisible({ timeout: 60_000 });
  await look(page, 'consent', found, pictures);
  await page.getByLabel(/I have read this/).check();
  await page.getByRole('button', { name: 'I agree' }).click();
  await look(page, 'code', found, pictures);
  await page.getByRole('button', { name: 'I have noted it' }).click();
  await look(page, 'demographics', found, pictures);
  await continueAtDesk(page, origin, shortStudy('questions'), 'archery/1/questionnaire');
  await expect(page.locator('.study-card .scale')).toBeVisible({ timeout: 60_000 });
  await look(page, 'question', found, pictures);
  expect(found).toEqual([]);
});
