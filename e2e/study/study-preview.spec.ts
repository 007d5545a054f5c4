import { readFileSync } from 'node:fs';
import type { Locator, Page } from '@playwright/test';
import { english } from '../../src/study/model/phrases/english';
import { expect, keepPicture } from '../page-fixture';
import { test } from './study-participant';
import { experimenter } from './study-server';

test.use({ viewport: { width: 1280, height: 800 } });

/** A question of each kind in the shipped example, by its label in the list of stops. */
const kinds = [
  ['likert', /^mine: /],
  ['slider', /^delay: /],
  ['choice', /^watched: /],
  ['number', /^guess: /],
  ['text', /^remarks: /],
  ['tlx', /^mental: /],
] as const;

test('a plan is previewed in headset and at the desk, in both languages, with nothing recorded @full', async ({
  page,
  origin,
}) => {
  // Other specs have studies on this server too.
  const studies = async () => (await (await experimenter(origin).ask('')).json()) as object;
  const before = await studies();
  const sent: string[] = [];
  page.on('request', (request) => {
    if (request.url().includes('/api/')) sent.push(request.url());
  });
  await page.goto(`${origin}/preview?plan=/studies/example.json`);
  await expect(page.getByRole('heading', { name: 'Two avatars in archery' })).toBeVisible();
  const view = page.locator('#view');
  const next = page.getByRole('button', { name: 'Next', exact: true }).first();
  await expect(page.getByRole('heading', { name: 'Taking part' })).toBeVisible();
  await keepPicture(page, 'study-preview-consent');
  await page.getByRole('combobox', { name: 'Language' }).first().selectOption('de');
  await expect(page.getByRole('heading', { name: 'Teilnahme' })).toBeVisible();

  await page
    .getByRole('button', { name: /^delay: / })
    .first()
    .click();
  await expect(page.locator('canvas')).toHaveAccessibleName(/Wie groß erschien Ihnen die Verzögerung/);
  // Pressed on the drawn sheet as by a ray: a value on the line, then the button to the next question.
  await page.locator('canvas').click({ position: await onSheet(page, 800, 470) });
  await keepPicture(page, 'study-preview-headset');
  await page.locator('canvas').click({ position: await onSheet(page, 960, 750) });
  await expect(view).toHaveAttribute('data-stop', /watched$/);
  await page.getByRole('button', { name: 'At the desk' }).click();
  await page.getByRole('radio', { name: 'Meine Arme' }).check();
  await keepPicture(page, 'study-preview-desk');
  for (const [kind, name] of kinds) {
    await page.getByRole('button', { name }).first().click();
    for (const place of ['In the headset', 'At the desk']) {
      await page.getByRole('button', { name: place }).click();
      await keepPicture(page, `study-question-${kind}${place === 'At the desk' ? '-desktop' : ''}`);
    }
  }
  await page.getByRole('button', { name: 'before Round 1' }).first().click();
  await keepPicture(page, 'study-preview-ready');
  await next.click();
  await expect(page.getByText('the participant plays, 70 s at most')).toBeVisible();
  await keepPicture(page, 'study-preview-playing');
  await page.reload();
  await expect(page.getByText('the participant plays, 70 s at most')).toBeVisible();

  expect(sent).toEqual([]);
  expect(await studies()).toEqual(before);
});

test('every screen in German is shown without English of the page and without cut-off labels @full', async ({
  page,
  origin,
}) => {
  // Every screen of the plan is drawn for both places: a busy machine takes minutes for them.
  test.setTimeout(300_000);
  await readCanvases(page);
  await page.goto(`${origin}/preview?plan=/studies/example.json`);
  await page.getByRole('combobox', { name: 'Language' }).first().selectOption('de');
  await expect(page.getByRole('heading', { name: 'Teilnahme' })).toBeVisible();
  const next = page.getByRole('button', { name: 'Next', exact: true }).first();
  const view = page.locator('#view');
  const count = await page.locator('#stops button').count();
  const stops = new Set<string | undefined>();
  const said = new Set<string>();
  for (let index = 0; index < count; index++) {
    stops.add(await view.evaluate(({ dataset }) => dataset.stop));
    await readScreen(page, said);
    for (const place of ['In the headset', 'At the desk']) {
      const shown = page.getByRole('button', { name: place });
      if (!(await shown.isEnabled())) continue;
      await shown.click();
      await readScreen(page, said);
    }
    if (index < count - 1) await next.click();
  }
  expect(stops.size).toBe(count);
  await expect(next).toBeDisabled();
  const text = [...said].join('\n');
  expect(text).toContain('Setzen Sie das Headset auf');
  expect(text).toContain('Weiter');
  expect(text).toContain('Entspannen Sie Ihre Arme.');
  expect(ofEnglish.filter((phrase) => text.includes(phrase))).toEqual([]);
});

/** What the page says in English in more than one word, each up to the first gap. */
const ofEnglish = Object.values(english)
  .flatMap((phrase) => (typeof phrase === 'string' ? [phrase] : Object.values(phrase)))
  .flatMap((phrase) => phrase.split(/\{\w+\}/))
  .map((part) => part.trim())
  .filter((part) => /\w{2,} \w{2,}/.test(part));

declare global {
  interface Window {
    /** What was drawn on canvases since it was last read. */
    drawn: string[];
  }
}

/** Keeps what is written on canvases: the sheet of the headset is a picture. */
async function readCanvases(page: Page): Promise<void> {
  await page.addInitScript(() => {
    window.drawn = [];
    const { fillText } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.fillText = function (text, x, y, most) {
      window.drawn.push(text);
      if (most === undefined) fillText.call(this, text, x, y);
      else fillText.call(this, text, x, y, most);
    };
  });
}

/**
 * Adds what stands on the screen at hand: words, what screen readers say, and what is drawn, in one line and line by
 * line.
 */
async function readScreen(page: Page, said: Set<string>): Promise<void> {
  const view = page.locator('#view');
  await expect(view.locator('.study-card:visible, canvas:visible, .playing:visible')).toHaveCount(1);
  const card = view.locator('.study-card:visible');
  if ((await card.count()) > 0) await expect(card).toHaveAttribute('lang', 'de');
  const found = await view.evaluate((node) => {
    const shown = [...node.querySelectorAll('*')].filter((one) => one.checkVisibility() && !one.closest('.playing'));
    const names = shown.flatMap((one) => [one.getAttribute('aria-label') ?? '', one.getAttribute('title') ?? '']);
    const drawn = window.drawn;
    window.drawn = [];
    const visible = shown.filter((one) => one.matches('.study-card')).map((one) => one.textContent ?? '');
    const cut = shown
      .filter((one) => one.matches('.study-card button') && one.scrollWidth > one.clientWidth + 1)
      .map((one) => one.textContent);
    return { said: [...names, ...visible, ...drawn, drawn.join(' ')], cut };
  });
  expect(found.cut).toEqual([]);
  for (const one of found.said) said.add(one);
}

test('mistakes of a plan are named as study:check names them @full', async ({ page, origin, complaints }) => {
  const plan = JSON.parse(readFileSync('public/studies/latency.json', 'utf8')) as {
    conditions: object[];
    seed: number;
  };
  const wrong = {
    ...plan,
    seed: -1,
    conditions: [{ ...plan.conditions[0], latencyMs: 900 }, ...plan.conditions.slice(1)],
  };
  await page.goto(`${origin}/preview`);
  await page
    .getByLabel('Study file', { exact: true })
    .setInputFiles({ name: 'mine.json', mimeType: 'application/json', buffer: Buffer.from(JSON.stringify(wrong)) });
  await expect(page.getByRole('alert').getByText(/^mine\.json: seed: /)).toBeVisible();
  await expect(page.getByText('mine.json: conditions[0].latencyMs: expected a number from 0 to 200')).toBeVisible();
  await keepPicture(page, 'study-preview-mistakes');
  complaints.allow(/404 \(Not Found\)/);
  await page.goto(`${origin}/preview?plan=/studies/none.json`);
  await expect(page.getByRole('alert')).toContainText('none.json');
});

test('the line of an unanswered slider is the same on either side of its middle @full', async ({ page, origin }) => {
  await page.goto(`${origin}/preview?plan=/studies/example.json`);
  await page
    .getByRole('button', { name: /^delay: / })
    .first()
    .click();
  await page.getByRole('button', { name: 'At the desk' }).click();
  const line = page.getByRole('slider');
  await expect(line).toHaveClass('open');
  expect(await unevenPixels(line)).toBe(0);
  await keepPicture(page, 'study-preview-slider-open');
  await line.press('Home');
  for (let steps = 0; steps < 30; steps++) await line.press('ArrowRight');
  expect(await unevenPixels(line)).toBeGreaterThan(100);
  await keepPicture(page, 'study-preview-slider');
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

/** Returns the position of a pixel of the sheet on the drawn one, as an option of Playwright's click. */
async function onSheet(page: Page, x: number, y: number) {
  const { width, height } = (await page.locator('canvas').boundingBox()) as { width: number; height: number };
  return { x: (x / 1200) * width, y: (y / 880) * height };
}
