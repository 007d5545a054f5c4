import type { ArcheryProbe } from '../src/archery-play';
import type { EmulatedHeadset, Point } from './emulated-headset';
import { emulatedHeadset, frames } from './emulated-headset';
import { expectHandsOnControllers } from './hands-on-controllers';
import { enterVr, expect, joint, keepPicture, open, probe, test } from './page-fixture';

// What is played does not depend on how many pixels show it.
test.use({ viewport: { width: 560, height: 350 } });

type Page = Parameters<typeof open>[0];

async function round(page: Page): Promise<ArcheryProbe> {
  const { game } = await probe(page);
  if (!game) throw new Error('no round is being played');
  return game;
}

/** The range with the emulated headset on, nobody in it yet. */
async function enterTheRange(page: Page, query = ''): Promise<EmulatedHeadset> {
  await open(page, `emulate&play=archery&seed=7&panel=off&quality=low${query}`);
  const headset = await emulatedHeadset(page);
  await enterVr(page);
  return headset;
}

for (const estimator of ['learned', 'ik', 'paper', 'hands-only'] as const) {
  test(`${estimator}: the archer in the emulated headset wins 50 of 50`, async ({ page }) => {
    test.setTimeout(240_000);
    await enterTheRange(page, `&estimator=${estimator}`);
    await expect.poll(async () => (await probe(page)).estimator).toBe(estimator);
    if (estimator === 'learned') {
      await expect.poll(async () => (await round(page)).stage, { timeout: 60_000 }).toBe('drawing');
      await keepPicture(page, 'archery-drawing');
      await expect.poll(async () => (await round(page)).arrowsLeft, { timeout: 60_000 }).toBe(4);
      await keepPicture(page, 'archery-flight');
      await expect.poll(async () => (await round(page)).score, { timeout: 60_000 }).toBe(5);
      await keepPicture(page, 'archery-hit');
    }
    await expect.poll(async () => (await round(page)).phase, { timeout: 200_000, intervals: [1000] }).toBe('over');
    const { score, end, arrowsLeft } = await round(page);
    expect({ score, end, arrowsLeft }).toEqual({ score: 50, end: 'targets', arrowsLeft: 1 });
    if (estimator === 'learned') await keepPicture(page, 'archery-result');
  });
}

const bowAt: Point = [-0.1, 1.35, -0.6];
const stringAt: Point = [-0.1, 1.4, -0.42];

/** Stands upright with the bow before the chest and the string hand at the string. */
async function stand(headset: EmulatedHeadset, x = 0): Promise<void> {
  await headset.place({
    head: { position: [x, 1.6, 0], orientation: [0, 0, 0, 1] },
    left: { position: [bowAt[0] + x, bowAt[1], bowAt[2]], orientation: [0, 0, 0.7071068, 0.7071068] },
    right: { position: [stringAt[0] + x, stringAt[1], stringAt[2]], orientation: [0, 0, -0.7071068, 0.7071068] },
  });
}

const press = (page: Page, side: 'left' | 'right', value: number) =>
  page.evaluate(([side, value]) => window.emulatedDevice.controllers[side].updateButtonValue('trigger', value), [
    side,
    value,
  ] as const);

/** Puts the string hand to where the page draws the string, so that a press nocks. */
async function nock(page: Page, headset: EmulatedHeadset): Promise<void> {
  await stand(headset);
  await expectHandsOnControllers(page, headset);
  await press(page, 'right', 0);
  await frames(page, 3);
  await press(page, 'right', 1);
  await expect.poll(async () => (await round(page)).stage).not.toBe('empty');
}

test('whoever leaves the zone is warned, and coming back is noticed', async ({ page }) => {
  const headset = await enterTheRange(page, '&actor=off');
  await stand(headset);
  await expect.poll(async () => (await round(page)).inZone).toBe(true);
  await stand(headset, 0.8);
  await expect.poll(async () => (await round(page)).inZone).toBe(false);
  await keepPicture(page, 'archery-outside');
  await stand(headset);
  await expect.poll(async () => (await round(page)).inZone).toBe(true);
});

test('a controller lost with the string drawn never shoots; the arrow goes back to the quiver', async ({ page }) => {
  const headset = await enterTheRange(page, '&actor=off');
  await nock(page, headset);
  await headset.place({ right: { position: [stringAt[0], stringAt[1], stringAt[2] + 0.4] } });
  await expect.poll(async () => (await round(page)).draw).toBeGreaterThan(0.2);
  await headset.setConnected('right', false);
  await expect.poll(async () => (await round(page)).stage).toBe('empty');
  await press(page, 'right', 0);
  await headset.setConnected('right', true);
  await frames(page, 5);
  expect((await round(page)).arrowsLeft).toBe(5);
});

test('hands are changed in the menu of the page, and remembered', async ({ page }) => {
  await open(page, 'emulate&play=archery&seed=7&panel=off&quality=low');
  await expect.poll(async () => (await round(page)).bowSide).toBe('left');
  await page.getByText('Rules and hands').click();
  await page.getByRole('switch', { name: 'Bow in the right hand' }).check();
  await expect.poll(async () => (await round(page)).bowSide).toBe('right');
  await page.reload();
  await expect.poll(async () => (await probe(page)).game?.bowSide, { timeout: 60_000 }).toBe('right');
});

test('bare hands: a pinch at the string nocks, opening it at full draw shoots', async ({ page }) => {
  const headset = await enterTheRange(page, '&actor=off');
  await headset.useInput('hand');
  await stand(headset);
  const pinch = (value: number) =>
    page.evaluate((value) => window.emulatedDevice.hands.right.updatePinchValue(value), value);
  await pinch(0);
  await frames(page, 10);
  // Where the string is depends on the bow hand as tracked: the other hand looks for it.
  await expect(async () => {
    const bow = await joint(page, 'leftHand');
    const string = await joint(page, 'rightHand');
    expect(Math.hypot(bow[0] - string[0], bow[1] - string[1], bow[2] - string[2])).toBeLessThan(0.4);
  }).toPass();
  await pinch(1);
  await expect.poll(async () => (await round(page)).stage).not.toBe('empty');
  await headset.place({ right: { position: [stringAt[0], stringAt[1], stringAt[2] + 0.45] } });
  await expect.poll(async () => (await round(page)).draw).toBeGreaterThan(0.2);
  await pinch(0);
  await expect.poll(async () => (await round(page)).arrowsLeft).toBe(4);
});

test('a round whose time runs out ends with the bell', async ({ page }) => {
  const headset = await enterTheRange(page, '&actor=off&seconds=4');
  await nock(page, headset);
  await headset.place({ right: { position: [stringAt[0], stringAt[1], stringAt[2] + 0.4] } });
  await expect.poll(async () => (await round(page)).draw).toBeGreaterThan(0.2);
  await press(page, 'right', 0);
  await expect.poll(async () => (await round(page)).phase).toBe('running');
  await expect.poll(async () => (await round(page)).phase).toBe('over');
  expect((await round(page)).end).toBe('time');
  expect((await round(page)).arrowsLeft).toBe(4);
});

test('at a desk the mouse aims, draws and shoots', async ({ page }) => {
  await open(page, 'play=archery&seed=7&panel=off&quality=low');
  await page.getByRole('button', { name: 'Shoot with the mouse' }).click();
  await expect.poll(async () => (await round(page)).arrowsLeft).toBe(5);
  await page.mouse.move(330, 130);
  await page.mouse.down();
  await expect.poll(async () => (await round(page)).draw, { timeout: 30_000 }).toBeGreaterThan(0.3);
  await page.mouse.up();
  await expect.poll(async () => (await round(page)).arrowsLeft, { timeout: 30_000 }).toBe(4);
  await page.keyboard.press('Escape');
});
