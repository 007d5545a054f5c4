import type { Locator } from '@playwright/test';
import { expect, keepPicture } from '../page-fixture';
import { continueAtDesk, reaches, test } from './study-participant';
import { experimenter, shippedPlan } from './study-server';

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

test('the buttons of consent are in sight on a phone and in a small window @full', async ({ page, origin }) => {
  const plan = shippedPlan('paper', 'long-consent');
  await experimenter(origin).addStudy(plan, false);
  await page.goto(await experimenter(origin).link(plan.id, 'P01', '&quality=low'));
  const card = page.locator('.study-card');
  const row = card.locator('.row');
  for (const [width, height] of [
    [390, 844],
    [640, 400],
    [1280, 720],
  ] as const) {
    await page.setViewportSize({ width, height });
    for (const top of [0, 10_000]) {
      await card.evaluate((element, top) => element.scrollTo({ top }), top);
      for (const name of ['I agree', 'I do not want to take part'])
        await expect(card.getByRole('button', { name })).toBeInViewport({ ratio: 1 });
      const [own, around] = [await row.boundingBox(), await card.boundingBox()];
      const below = around!.y + around!.height - own!.y - own!.height;
      // The text ends at the buttons; only the card's last line may follow.
      if (top === 0) expect(below, `${width} × ${height}`).toBeLessThan(2);
    }
    // What the keyboard reaches is not under the buttons.
    await card.evaluate((element) => element.scrollTo({ top: 0 }));
    const box = card.getByRole('checkbox').last();
    await card.getByRole('button', { name: 'I do not want to take part' }).focus();
    await page.keyboard.press('Shift+Tab');
    await expect(box).toBeFocused();
    const [reached, buttons] = [await box.boundingBox(), await row.boundingBox()];
    expect(reached!.y + reached!.height, `${width} × ${height}`).toBeLessThanOrEqual(buttons!.y);
  }
});
