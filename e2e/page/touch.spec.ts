import { devices, type Page } from '@playwright/test';
import { goldenMocap } from '../../tests/threepoint/core/mocap/golden-mocap';
import { drawSeldom } from '../draw-seldom';
import { driveTime, endDrivenTime } from '../driven-time';
import { card, choose } from '../mocap-card';
import { collectErrors, expect, gameOn, keepPicture, overlap, probe, freshTest as test } from '../page-fixture';

/** Opens the page on a phone with this width and height [CSS pixels]. */
async function openOnPhone(page: Page, query = ''): Promise<void> {
  await page.goto(`/?quality=low&estimator=ik${query}`);
  await page.waitForFunction(() => window.threepoint?.probe().ready === true, undefined, { timeout: 60_000 });
}

const { defaultBrowserType: _, ...pixel } = devices['Pixel 7'];

test.describe('on a phone', () => {
  test('the whole page is driven by touch: controls, archery, the ball game and back @full', async ({
    browser,
    origin,
  }) => {
    test.setTimeout(240_000);
    const context = await browser.newContext({ ...pixel, baseURL: origin, serviceWorkers: 'block' });
    await drawSeldom(context);
    const page = await context.newPage();
    const { errors } = collectErrors(page, origin);
    const button = (name: string | RegExp) => page.getByRole('button', { name });
    const touchScreen = await context.newCDPSession(page);
    /** A finger on the picture at these points of the window in turn. */
    const drag = async (...points: readonly (readonly [x: number, y: number])[]) => {
      for (const [index, [x, y]] of points.entries()) {
        const type = index === 0 ? 'touchStart' : 'touchMove';
        await touchScreen.send('Input.dispatchTouchEvent', { type, touchPoints: [{ x, y }] });
      }
    };
    const lift = () => touchScreen.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
    try {
      await openOnPhone(page, '&seed=7');

      await button('Controls').tap();
      for (const name of ['Avatar', 'Recording', 'View', 'Body']) {
        await page.getByRole('tab', { name }).tap();
        await expect(page.getByRole('tab', { name })).toHaveAttribute('aria-selected', 'true');
      }
      await page.getByRole('tab', { name: 'View' }).tap();
      await button('Front').tap();
      await expect.poll(async () => (await probe(page)).view).toBe('front');
      await button('Behind').tap();
      await expect.poll(async () => (await probe(page)).view).toBe('third-person');
      await page.getByText('Mirror', { exact: true }).last().tap();
      await keepPicture(page, 'touch-controls');
      await button('Controls').tap();
      await button('Centre').tap();

      await button('Archery').tap();
      await expect(button('Archery')).toHaveAttribute('aria-pressed', 'true', { timeout: 60_000 });
      expect(await overlap(page, '#masthead h1', '.panel-bar')).toBe(false);
      await button('Shoot by touch').tap();
      await keepPicture(page, 'touch-archery');
      await expect.poll(async () => (await gameOn(page, 'archery'))?.arrowsLeft).toBe(5);
      await driveTime(page);
      await drag([200, 520], [205, 480]);
      await expect.poll(async () => (await gameOn(page, 'archery'))?.draw).toBeGreaterThan(0.3);
      await lift();
      await expect.poll(async () => (await gameOn(page, 'archery'))?.arrowsLeft).toBe(4);
      await endDrivenTime(page);

      await button('Ball game').tap();
      await expect(button('Ball game')).toHaveAttribute('aria-pressed', 'true', { timeout: 60_000 });
      // The finger that shot plays here too, until the computer does.
      await expect(page.getByText(/^Put a finger/)).toBeVisible();
      await keepPicture(page, 'touch-ball');
      await button('Let the computer play').tap();
      await expect(button('Play by touch')).toBeVisible();
      await button('Mirror').tap();
      await expect(button('Mirror')).toHaveAttribute('aria-pressed', 'true', { timeout: 60_000 });

      await button('Enter VR (emulated)').tap();
      await expect.poll(async () => (await probe(page)).activity, { timeout: 30_000 }).toBe('vr');
      await button('Exit VR').tap();
      await expect.poll(async () => (await probe(page)).activity).toBe('desktop');
      expect(errors).toEqual([]);
    } finally {
      await context.close();
    }
  });
});

test.describe('on a turned phone', () => {
  test.use({ ...pixel, viewport: { width: 390, height: 844 } });

  test('an open motion does not widen the page when the phone is turned and turned back @full', async ({ page }) => {
    const motionFiles = Object.entries(goldenMocap[0]!.files).map(([name, text]) => ({
      name,
      mimeType: 'text/plain',
      buffer: Buffer.from(text),
    }));
    await openOnPhone(page, '&actor=off');
    const controls = page.getByRole('button', { name: 'Controls' });
    await controls.tap();
    await choose(page, motionFiles);
    await controls.tap();
    await expect(card(page)).toBeVisible({ timeout: 60_000 });
    for (const [width, height] of [
      [844, 390],
      [390, 844],
      [320, 640],
    ] as const) {
      await page.setViewportSize({ width, height });
      await expect.poll(() => page.evaluate(() => [innerWidth, innerHeight])).toEqual([width, height]);
      const motion = (await card(page).boundingBox())!;
      expect(motion.x + motion.width).toBeLessThanOrEqual(width);
    }
  });
});

/** The parts of the page that never lie over each other. */
const parts = [
  '#masthead h1',
  '#play > .segments',
  '#play > .round',
  '.panel-bar',
  '.panel',
  'button.enter',
  'button.enter-ar',
  '#notices',
];

/**
 * Returns the pairs of shown parts that lie over each other, the parts that lie over the body, and those beyond the
 * window. A notice may lie over the body: it leaves.
 */
const collisions = (page: Page): Promise<string[]> =>
  page.evaluate((parts) => {
    const { box } = window.threepoint!.probe().avatar;
    const boxes = parts.flatMap((part) => {
      const shown = document.querySelector(part)?.getBoundingClientRect();
      return shown?.height
        ? [{ part, left: shown.left, right: shown.right, top: shown.top, bottom: shown.bottom }]
        : [];
    });
    type Box = Pick<DOMRect, 'left' | 'right' | 'top' | 'bottom'>;
    const meet = (a: Box, b: Box) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    const inWindow = ({ left, right, top, bottom }: Box) =>
      left >= 0 && top >= 0 && right <= window.innerWidth && bottom <= window.innerHeight;
    return [
      ...boxes.flatMap((a, index) =>
        boxes.slice(index + 1).flatMap((b) => (meet(a, b) ? [`${a.part} over ${b.part}`] : [])),
      ),
      ...boxes.flatMap(({ part, ...each }) =>
        part !== '#notices' && meet(each, box) ? [`${part} over the body`] : [],
      ),
      ...[...boxes, { part: 'the body', ...box }].flatMap(({ part, ...each }) =>
        inWindow(each) ? [] : [`${part} beyond the window`],
      ),
    ];
  }, parts);

for (const play of ['studio', 'archery', 'ball'] as const)
  test(`no part of the page lies over another or over the body in any window: ${play} @full`, async ({ page }) => {
    await page.setViewportSize({ width: 1280, height: 720 });
    // An address without an avatar leaves a notice.
    await openOnPhone(page, `&play=${play}&panel=off&actor=off&emulate&seed=5&avatar=`);
    if (play !== 'studio') await expect(page.locator('#play > .round')).toBeVisible();
    const notice = page.locator('.notice').first();
    await expect(notice).toBeVisible();
    for (const [width, height] of [
      [390, 844],
      [720, 800],
      [760, 600],
      [800, 500],
      [800, 360],
      [640, 360],
      [1280, 720],
    ] as const) {
      await page.setViewportSize({ width, height });
      for (const controls of ['open', 'closed']) {
        await page.getByRole('button', { name: 'Controls' }).click();
        await page.getByRole('button', { name: 'Centre' }).click();
        const where = `${width} × ${height}, controls ${controls}`;
        await expect.poll(() => collisions(page), { message: where }).toEqual([]);
        expect((await notice.boundingBox())!.width, where).toBeGreaterThan(200);
        if (width === 390 || height === 500) await keepPicture(page, `narrow-${play}-${width}x${height}-${controls}`);
      }
    }
  });
