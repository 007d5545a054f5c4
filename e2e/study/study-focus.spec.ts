import type { Locator } from '@playwright/test';
import { expect, keepPicture } from '../page-fixture';
import { continueAtDesk, reaches, test } from './study-participant';
import { shippedPlan } from './study-server';

test('the keyboard stays within the card when another question replaces one that was answered @full', async ({
  page,
  origin,
}) => {
  await continueAtDesk(page, origin, shippedPlan('paper', 'focus'), 'archery/1/questionnaire');
  const card = page.locator('.study-card');
  for (const [id, next] of [
    ['Q1', 'Q2'],
    ['Q2', 'Q3'],
  ] as const) {
    await reaches(page, `question-${id}`);
    await card.getByRole('radio').first().focus();
    await page.keyboard.press('Space');
    await card.getByRole('button', { name: 'Next' }).focus();
    await page.keyboard.press('Enter');
    await reaches(page, `question-${next}`);
    // The words of the question are read out, and its first answer is one key away.
    await expect(card.locator('legend')).toBeFocused();
    await page.keyboard.press('Tab');
    await expect(card.getByRole('radio').first()).toBeFocused();
  }
});

test('the line of an unanswered slider is the same on either side of its middle @full', async ({ page, origin }) => {
  await continueAtDesk(page, origin, shippedPlan('example', 'slider'), 'archery/1/questionnaire');
  for (let question = 0; question < 2; question++) {
    await page.getByRole('radio').first().check();
    await page.getByRole('button', { name: 'Next' }).click();
  }
  const line = page.getByRole('slider');
  await expect(line).toHaveClass('open');
  expect(await unevenPixels(line)).toBe(0);
  await keepPicture(page, 'study-slider-open');
  await line.press('Home');
  for (let steps = 0; steps < 30; steps++) await line.press('ArrowRight');
  expect(await unevenPixels(line)).toBeGreaterThan(100);
});

/** How many pixels of the left half of an element's picture are not as those of its mirrored right half. */
async function unevenPixels(element: Locator): Promise<number> {
  const picture = (await element.screenshot()).toJSON().data;
  return element.page().evaluate(async (bytes) => {
    const image = await createImageBitmap(new Blob([new Uint8Array(bytes)]));
    const { width, height } = image;
    const context = new OffscreenCanvas(width, height).getContext('2d') as OffscreenCanvasRenderingContext2D;
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    const pixel = (x: number, y: number) => data.subarray(4 * (y * width + x), 4 * (y * width + x) + 3);
    let uneven = 0;
    for (let y = 0; y < height; y++) {
      for (let x = 0; x < width / 2; x++) {
        const mirrored = pixel(width - 1 - x, y);
        // The rounding of an edge may fall otherwise on one side.
        if (pixel(x, y).some((value, index) => Math.abs(value - (mirrored[index] as number)) > 40)) uneven += 1;
      }
    }
    return uneven;
  }, picture);
}
