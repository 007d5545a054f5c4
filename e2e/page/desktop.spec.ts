import type { Page } from '@playwright/test';
import { reportFigures } from '../../tests/reliability/report-figures';
import {
  expect,
  freshTest,
  joint,
  keepPicture,
  load,
  open,
  openWithHeadset,
  probe,
  settledJoint,
  test,
} from '../page-fixture';

freshTest('a newcomer sees a moving body within seconds, without touching anything', async ({ page }) => {
  await open(page, 'quality=low');
  const { loading } = await probe(page);
  console.log('loading [ms]', JSON.stringify(loading));
  const before = await joint(page, 'leftHand');
  await expect
    .poll(async () => {
      const now = await joint(page, 'leftHand');
      return Math.hypot(now[0] - before[0], now[1] - before[1], now[2] - before[2]);
    })
    .toBeGreaterThan(0.02);
  await expect(page.getByRole('heading', { name: 'threepoint' })).toBeVisible();
});

freshTest('the note about a missing headset leaves by itself, and the picture grows @full', async ({ page }) => {
  await page.setViewportSize({ width: 640, height: 360 });
  await load(page, 'quality=low&estimator=ik&panel=off');
  const note = page.getByText('An emulated headset takes its place.');
  await expect(note).toBeVisible();
  const tall = async () => (await probe(page)).avatar.box.bottom - (await probe(page)).avatar.box.top;
  const before = await tall();
  await expect(note).toBeHidden();
  await expect.poll(tall).toBeGreaterThan(before + 20);
  await keepPicture(page, 'zoomed-page');
});

test('the keyboard opens the details of the methods for researchers, which are folded at first @full', async ({
  page,
}) => {
  await load(page, 'quality=low&estimator=ik&panel=on');
  await page.getByRole('tab', { name: 'Body' }).click();
  const precise = page.getByText('Six joints in closed form');
  await expect(page.getByText('Calculated from how joints bend')).toBeVisible();
  await expect(precise).toBeHidden();
  await page.getByText('Details of the methods').focus();
  await page.keyboard.press('Enter');
  await expect(precise).toBeVisible();
  await keepPicture(page, 'details-of-methods');
});

/** Returns the box of the avatar's joints in the window [CSS pixels]. */
const bodyBox = async (page: Page) => (await probe(page)).avatar.box;

test('the first picture shows a whole clothed person from the front, clear of the button', async ({ page }) => {
  for (const [width, height] of [
    [1280, 720],
    [820, 520],
    [390, 844],
  ] as const) {
    await page.setViewportSize({ width, height });
    await load(page, 'quality=low&estimator=ik');
    const { view, avatar } = await probe(page);
    expect([view, avatar.name]).toEqual(['front', 'Woman']);
    const button = (await page.getByRole('button', { name: /^Enter VR/ }).boundingBox())!;
    const { left, right, top, bottom } = avatar.box;
    expect(bottom, `${width}: feet`).toBeLessThan(button.y);
    expect(top, `${width}: head or hand`).toBeLessThan(height / 2);
    expect(left, `${width}`).toBeGreaterThan(0);
    expect(right, `${width}`).toBeLessThan(width);
  }
});

for (const [how, zoomIn] of [
  ['the wheel', async (page: Page) => page.mouse.wheel(0, -240)],
  ['the plus key', async (page: Page) => page.keyboard.press('+')],
] as const)
  test(`zooming in with ${how} keeps the face in the picture @full`, async ({ page }) => {
    await openWithHeadset(page, 'estimator=ik&panel=off');
    await page.getByRole('button', { name: 'Centre' }).click();
    await expect.poll(async () => (await bodyBox(page)).bottom).toBeLessThan(600);
    const before = await bodyBox(page);
    await page.locator('#stage').focus();
    await page.mouse.move(480, 300);
    for (let times = 0; times < 20; times++) await zoomIn(page);
    const tall = before.bottom - before.top;
    await expect.poll(async () => (await bodyBox(page)).bottom).toBeGreaterThan(before.top + 2 * tall);
    const { top } = await bodyBox(page);
    expect(top).toBeGreaterThan(0);
    expect(top).toBeLessThan(300);
    await keepPicture(page, `zoomed-by-${how.replaceAll(' ', '-')}`);
  });

test('the estimators are switched live, on the same motion, without moving the hands', async ({ page }) => {
  await openWithHeadset(page);
  const hands = await settledJoint(page, 'rightHand');
  for (const [label, name] of [
    ['Inverse kinematics', 'ik'],
    ['Paper', 'paper'],
    ['Hands only', 'hands-only'],
    ['Learned', 'learned'],
  ] as const) {
    await page.getByRole('radio', { name: label, exact: true }).check();
    await expect.poll(async () => (await probe(page)).estimator).toBe(name);
    const now = await joint(page, 'rightHand');
    expect(1000 * Math.hypot(now[0] - hands[0], now[1] - hands[1], now[2] - hands[2])).toBeLessThan(1);
  }
  await page.keyboard.press('2');
  await expect.poll(async () => (await probe(page)).estimator).toBe('ik');
});

test('Esc closes the controls and returns the focus to their button, and nothing else is closed', async ({ page }) => {
  await open(page, 'quality=low&estimator=ik&panel=on');
  const opener = page.getByRole('button', { name: 'Controls' });
  const isOpen = (open: boolean) => expect(opener).toHaveAttribute('aria-expanded', String(open));
  await page.getByRole('tab', { name: 'Body' }).focus();
  await page.keyboard.press('Escape');
  await isOpen(false);
  await expect(opener).toBeFocused();
  await page.keyboard.press('Escape');
  await isOpen(false);
  await opener.click();
  await isOpen(true);
});

freshTest('address, title and picture name the game; Back and reload keep it @full', async ({ page }) => {
  const canvas = page.locator('#stage');
  const games = async (name: string | undefined) =>
    expect.poll(async () => (await probe(page)).game?.name, { timeout: 60_000 }).toBe(name);
  await open(page, 'quality=low&estimator=ik&bots=on');
  const label = await canvas.getAttribute('aria-label');
  await page.getByRole('button', { name: 'Archery' }).click();
  await games('archery');
  await expect(page).toHaveTitle('Archery · threepoint');
  await expect(canvas).toHaveAccessibleName('The archery range. Arrow keys turn the camera, plus and minus zoom.');
  await page.getByRole('button', { name: 'Ball game' }).click();
  await games('ball');
  expect(new URL(page.url()).searchParams.get('play')).toBe('ball');
  await page.goBack();
  await games('archery');
  await page.reload();
  await games('archery');
  await page.goBack();
  await games(undefined);
  await expect(page).toHaveTitle('threepoint');
  await expect(canvas).toHaveAccessibleName(label ?? '');
  await page.goForward();
  await games('archery');
});

test('single keys can be switched off, for who presses them by chance @full', async ({ page }) => {
  await open(page, 'quality=low&estimator=ik');
  await page.getByRole('tab', { name: 'View' }).click();
  const singleKeys = page.getByRole('switch', { name: 'Single keys' });
  const { view } = await probe(page);
  await singleKeys.uncheck();
  await page.keyboard.press('v');
  await singleKeys.check();
  expect((await probe(page)).view).toBe(view);
  await page.keyboard.press('v');
  await expect.poll(async () => (await probe(page)).view).not.toBe(view);
  await keepPicture(page, 'single-keys');
});

test('third person, front and first person are a button away @full', async ({ page }) => {
  await open(page, 'quality=low');
  await page.getByRole('tab', { name: 'View' }).click();
  for (const [label, view] of [
    ['Front', 'front'],
    ['Your eyes', 'first-person'],
    ['Behind', 'third-person'],
  ] as const) {
    const choice = page.getByRole('button', { name: label });
    await choice.click();
    await expect(choice).toHaveAttribute('aria-pressed', 'true');
    await expect.poll(async () => (await probe(page)).view).toBe(view);
    await keepPicture(page, `view-${view}`);
  }
});

test('the overlay names the stages of a frame, the estimator and where it runs @full', async ({ page }) => {
  await openWithHeadset(page, 'estimator=learned');
  await page.getByRole('tab', { name: 'View' }).click();
  await page.getByRole('switch', { name: 'Frame times' }).check();
  const overlay = page.getByRole('region', { name: 'Frame time' });
  for (const stage of ['tracking', 'features', 'inference', 'kinematics', 'skinning', 'render']) {
    await expect(overlay.getByRole('rowheader', { name: stage })).toBeVisible();
  }
  await expect(overlay).toContainText(/plain/i);
  await expect(overlay).toContainText(/missed at/);
});

for (const [where, query, viewport] of [
  ['in a game', 'play=archery&panel=on', { width: 960, height: 600 }],
  ['in a narrow window', 'panel=on', { width: 600, height: 800 }],
] as const)
  test(`the controls are open ${where} where the address asks for them @full`, async ({ page }) => {
    await page.setViewportSize(viewport);
    await open(page, `${query}&quality=low&estimator=ik`);
    await expect(page.getByRole('button', { name: 'Controls' })).toHaveAttribute('aria-expanded', 'true');
  });

/** The luminance of a colour of three channels in [0, 1], as WCAG defines it. */
const luminance = (channels: readonly number[]): number => {
  const [r = 0, g = 0, b = 0] = channels.map((value) =>
    value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4,
  );
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};

test('text stands out from its background, for every kind of colour vision @full', async ({ page }) => {
  await open(page, 'quality=low&estimator=ik');
  /** The colour that a browser computes for a variable of the page's styles. */
  const colour = (name: string): Promise<number[]> =>
    page.evaluate((variable) => {
      const probe = document.body.appendChild(document.createElement('i'));
      probe.style.color = `var(--${variable})`;
      const channels = getComputedStyle(probe).color.match(/[\d.]+/g) ?? [];
      probe.remove();
      return channels.slice(0, 3).map((channel) => Number(channel) / 255);
    }, name);
  const contrasts = [];
  for (const colorScheme of ['light', 'dark'] as const) {
    await page.emulateMedia({ colorScheme });
    for (const [text, background] of [
      ['ink', 'glass'],
      ['ink-soft', 'glass'],
      ['primary-ink', 'primary'],
      ['trouble', 'glass'],
      ['surface', 'first'],
      ['surface', 'second'],
    ] as const) {
      const both = [luminance(await colour(text)), luminance(await colour(background))] as const;
      contrasts.push((Math.max(...both) + 0.05) / (Math.min(...both) + 0.05));
    }
  }
  await page.emulateMedia({ colorScheme: null });
  const least = Math.min(...contrasts);
  expect(least).toBeGreaterThan(4.5);
  reportFigures('comfort', { 'least contrast of text': `${least.toFixed(1)} : 1`, 'larger text': '130 %, remembered' });
});

test('going from place to place leaves no geometry and no texture on the graphics device @full', async ({ page }) => {
  test.setTimeout(300_000);
  await page.setViewportSize({ width: 320, height: 200 });
  // In low quality nothing is reflected.
  await open(page, 'quality=high&estimator=ik&panel=off');
  /** What the studio holds after a visit to the range, once its own picture is drawn. */
  const heldAfterVisit = async () => {
    for (const name of ['Archery', 'Mirror']) {
      const place = page.getByRole('button', { name, exact: true });
      await place.press('Enter');
      await expect(place).toHaveAttribute('aria-pressed', 'true', { timeout: 60_000 });
      const { count } = (await probe(page)).frame;
      await expect.poll(async () => (await probe(page)).frame.count, { timeout: 60_000 }).toBeGreaterThan(count + 1);
    }
    const { geometries, textures } = (await probe(page)).drawing;
    return { geometries, textures };
  };
  const first = await heldAfterVisit();
  expect(await heldAfterVisit()).toEqual(first);
});
