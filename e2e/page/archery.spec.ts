import type { ArcheryProbe } from '../../src/page/archery/archery-play';
import { driveTime, holdAt } from '../driven-time';
import type { EmulatedHeadset, Rotation } from '../emulated-headset';
import { emulatedHeadset, frames } from '../emulated-headset';
import { enterVr, expect, keepPicture, load, open, probe, settledJoint, test } from '../page-fixture';

// What is played does not depend on how many pixels show it.
test.use({ viewport: { width: 800, height: 500 } });

type Page = Parameters<typeof open>[0];

/** The round as it stands; between two rounds there is none for a frame. */
async function round(page: Page): Promise<ArcheryProbe> {
  const shown = await page.waitForFunction(() => window.threepoint?.probe().game, undefined, patience);
  return (await shown.jsonValue()) as ArcheryProbe;
}

/** The range, with the emulated headset worn. */
async function enterTheRange(page: Page, query = ''): Promise<EmulatedHeadset> {
  await open(page, `emulate&play=archery&seed=7&panel=off&quality=low${query}`);
  const headset = await emulatedHeadset(page);
  await enterVr(page);
  return headset;
}

const patience = { timeout: 60_000 };

for (const estimator of ['learned', 'ik', 'paper', 'hands-only'] as const) {
  // The hands are the same with each body: one in full, the others by night.
  const suite = estimator === 'learned' ? '@full' : '@nightly';
  test(`${estimator}: the archer in the emulated headset wins 50 of 50 ${suite}`, async ({ page }) => {
    test.setTimeout(240_000);
    await enterTheRange(page, `&estimator=${estimator}`);
    expect((await probe(page)).estimator).toBe(estimator);
    if (estimator === 'learned') {
      await holdAt<ArcheryProbe>(page, { stage: 'drawing' });
      await keepPicture(page, 'archery-drawing');
      await holdAt<ArcheryProbe>(page, { arrowsLeft: 4 });
      await keepPicture(page, 'archery-flight');
      await holdAt<ArcheryProbe>(page, { score: 5 });
      await keepPicture(page, 'archery-hit');
    }
    await holdAt<ArcheryProbe>(page, { phase: 'over' });
    const { score, end } = await round(page);
    expect({ score, end }).toEqual({ score: 50, end: 'targets' });
    if (estimator === 'learned') await keepPicture(page, 'archery-result');
  });
}

/** Stands upright with the bow at arm's length and the string hand beside it. */
async function stand(
  headset: EmulatedHeadset,
  x = 0,
  thumbsUp: { left: Rotation; right: Rotation } = asHeld,
): Promise<void> {
  await headset.place({
    head: { position: [x, 1.6, 0], orientation: [0, 0, 0, 1] },
    left: { position: [x - 0.1, 1.35, -0.6], orientation: thumbsUp.left },
    right: { position: [x - 0.1, 1.35, -0.4], orientation: thumbsUp.right },
  });
}

/** Controllers are held with the thumbs up; bare hands lie palm down until they are turned. */
const asHeld: { left: Rotation; right: Rotation } = { left: [0, 0, 0, 1], right: [0, 0, 0, 1] };
const turned: { left: Rotation; right: Rotation } = {
  left: [0, 0, Math.SQRT1_2, Math.SQRT1_2],
  right: [0, 0, -Math.SQRT1_2, Math.SQRT1_2],
};

/** Moves the string hand to where the string is, and `behind` [m] further back. */
async function reachForString(page: Page, headset: EmulatedHeadset, behind = 0): Promise<void> {
  const wrist = await settledJoint(page, 'rightHand');
  const { nockPoint } = await round(page);
  if (!nockPoint) throw new Error('no hand holds the bow');
  const ray = await page.evaluate(() => {
    const { controllers, hands, primaryInputMode } = window.emulatedDevice;
    const { x, y, z } = (primaryInputMode === 'hand' ? hands : controllers).right.position;
    return [x, y, z] as const;
  });
  await headset.place({
    right: {
      position: [
        ray[0] + nockPoint[0] - wrist[0],
        ray[1] + nockPoint[1] - wrist[1],
        ray[2] + nockPoint[2] - wrist[2] + behind,
      ],
    },
  });
  await frames(page, 4);
}

const press = (page: Page, side: 'left' | 'right', value: number) =>
  page.evaluate(([side, value]) => window.emulatedDevice.controllers[side].updateButtonValue('trigger', value), [
    side,
    value,
  ] as const);

/** Nocks and draws with what holds the string. */
async function nockAndDraw(
  page: Page,
  headset: EmulatedHeadset,
  hold: (value: number) => Promise<unknown>,
  thumbsUp = asHeld,
): Promise<void> {
  await stand(headset, 0, thumbsUp);
  await hold(0);
  await reachForString(page, headset);
  await hold(1);
  await expect.poll(async () => (await round(page)).stage).not.toBe('empty');
  await reachForString(page, headset, 0.4);
  await expect.poll(async () => (await round(page)).draw).toBeGreaterThan(0.2);
}

const pinch = (page: Page, value: number) =>
  page.evaluate((value) => window.emulatedDevice.hands.right.updatePinchValue(value), value);

test('a person who leaves the zone is warned, and coming back is noticed @nightly', async ({ page }) => {
  const headset = await enterTheRange(page, '&actor=off');
  await stand(headset);
  await expect.poll(async () => (await round(page)).inZone).toBe(true);
  await stand(headset, 0.8);
  await expect.poll(async () => (await round(page)).inZone).toBe(false);
  await keepPicture(page, 'archery-outside');
  await stand(headset);
  await expect.poll(async () => (await round(page)).inZone).toBe(true);
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

test.describe('one arrow', () => {
  // No picture of it is kept, and frames are quicker so.
  test.use({ viewport: { width: 480, height: 300 } });

  test('a controller lost with the string drawn never shoots; the arrow goes back to the quiver @full', async ({
    page,
  }) => {
    const headset = await enterTheRange(page, '&actor=off');
    await nockAndDraw(page, headset, (value) => press(page, 'right', value));
    await headset.setConnected('right', false);
    await expect.poll(async () => (await round(page)).stage).toBe('empty');
    await press(page, 'right', 0);
    await headset.setConnected('right', true);
    await frames(page, 5);
    expect((await round(page)).arrowsLeft).toBe(5);
  });

  test('bare hands: a pinch at the string nocks, opening it at full draw shoots @full', async ({ page }) => {
    const headset = await enterTheRange(page, '&actor=off');
    await headset.useInput('hand');
    await nockAndDraw(page, headset, (value) => pinch(page, value), turned);
    await pinch(page, 0);
    await expect.poll(async () => (await round(page)).arrowsLeft).toBe(4);
  });

  test('a round whose time runs out ends with the bell @nightly', async ({ page }) => {
    const headset = await enterTheRange(page, '&actor=off&seconds=4');
    await nockAndDraw(page, headset, (value) => press(page, 'right', value));
    await Promise.all([holdAt<ArcheryProbe>(page, { phase: 'running' }), press(page, 'right', 0)]);
    await holdAt<ArcheryProbe>(page, { phase: 'over' });
    expect((await round(page)).end).toBe('time');
    expect((await round(page)).arrowsLeft).toBe(4);
  });
});

test('at a desk the mouse aims, draws and shoots', async ({ page }) => {
  await open(page, 'play=archery&seed=7&panel=off&quality=low&actor=off');
  await page.getByRole('button', { name: 'Shoot with the mouse' }).click();
  await expect(page.getByRole('button', { name: 'Shoot with the mouse' })).toBeHidden();
  await expect.poll(async () => (await round(page)).arrowsLeft).toBe(5);
  await driveTime(page);
  await page.mouse.move(330, 130);
  await page.mouse.down();
  await expect.poll(async () => (await round(page)).draw).toBeGreaterThan(0.3);
  await page.mouse.up();
  await expect.poll(async () => (await round(page)).arrowsLeft).toBe(4);
  await page.keyboard.press('Escape');
});
