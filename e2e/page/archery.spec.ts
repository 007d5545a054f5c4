import type { ArcheryProbe } from '../../src/page/archery/archery-play';
import { driveTime, holdAt } from '../driven-time';
import { emulatedHeadset } from '../emulated-headset';
import { enterVr, expect, keepPicture, load, open, test } from '../page-fixture';

// What is played does not depend on how many pixels show it.
test.use({ viewport: { width: 800, height: 500 } });

type Page = Parameters<typeof open>[0];

/** The round as it stands; between two rounds there is none for a frame. */
async function round(page: Page): Promise<ArcheryProbe> {
  const shown = await page.waitForFunction(() => window.threepoint?.probe().game, undefined, patience);
  return (await shown.jsonValue()) as ArcheryProbe;
}

const patience = { timeout: 60_000 };

test('the archer in the emulated headset wins 50 of 50 @full', async ({ page }) => {
  test.setTimeout(240_000);
  await open(page, 'emulate&play=archery&seed=7&panel=off&quality=low');
  await emulatedHeadset(page);
  await enterVr(page);
  await holdAt<ArcheryProbe>(page, { stage: 'drawing' });
  await keepPicture(page, 'archery-drawing');
  await holdAt<ArcheryProbe>(page, { arrowsLeft: 4 });
  await keepPicture(page, 'archery-flight');
  await holdAt<ArcheryProbe>(page, { score: 5 });
  await keepPicture(page, 'archery-hit');
  await holdAt<ArcheryProbe>(page, { phase: 'over' });
  const { score, end } = await round(page);
  expect({ score, end }).toEqual({ score: 50, end: 'targets' });
  await keepPicture(page, 'archery-result');
});

test('hands are changed in the menu of the page, and remembered @full', async ({ page }) => {
  await open(page, 'emulate&play=archery&seed=7&panel=off&quality=low');
  await expect.poll(async () => (await round(page)).bowSide).toBe('left');
  await page.getByText('Rules and hands').click();
  await page.getByRole('switch', { name: 'Bow in the right hand' }).check();
  await expect.poll(async () => (await round(page)).bowSide).toBe('right');
  await load(page, 'emulate&play=archery&seed=7&panel=off&quality=low');
  await expect.poll(async () => (await round(page)).bowSide).toBe('right');
});

test('at a desk the mouse aims, draws and shoots', async ({ page }) => {
  await open(page, 'play=archery&seed=7&panel=off&quality=low&actor=off');
  await page.getByRole('button', { name: 'Shoot with the mouse' }).click();
  await expect(page.getByRole('button', { name: 'Shoot with the mouse' })).toBeDisabled();
  await expect.poll(async () => (await round(page)).arrowsLeft).toBe(5);
  await driveTime(page);
  await page.mouse.move(330, 130);
  await page.mouse.down();
  await expect.poll(async () => (await round(page)).draw).toBeGreaterThan(0.3);
  await page.mouse.up();
  await expect.poll(async () => (await round(page)).arrowsLeft).toBe(4);
  await page.keyboard.press('Escape');
});
