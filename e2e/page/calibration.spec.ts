import { armSpanFromFingertipSpan } from 'threepoint/core';
import {
  distance,
  enterVr,
  expect,
  freshTest,
  joint,
  keepPicture,
  load,
  openWithHeadset,
  overlap,
  probe,
  settledJoint,
  test,
} from '../page-fixture';
import { lookingAtMenu, pressInMenu, recordCanvasText, waitForCanvasText } from './hands-on-menu';

const withHeadset = 'emulate&actor=off&quality=low';

/** The pose of the guided calibration. */
const armsAhead = {
  head: { position: [0, 1.72, 0], orientation: [0, 0, 0, 1] },
  left: { position: [-0.19, 1.4, -0.6], orientation: [0, 0, 0, 1] },
  right: { position: [0.19, 1.4, -0.6], orientation: [0, 0, 0, 1] },
} as const;

test('a typed height and arm span are used, remembered after a reload, and forgotten on request @full', async ({
  page,
}) => {
  await openWithHeadset(page);
  const before = (await probe(page)).calibration;
  await page.getByRole('spinbutton', { name: 'Height in centimetres' }).fill('192');
  await page.getByRole('spinbutton', { name: 'Arm span in centimetres' }).fill('160');
  await page.keyboard.press('Tab');
  await expect.poll(async () => (await probe(page)).calibration.armSpan).toBeCloseTo(armSpanFromFingertipSpan(1.6), 3);
  const { eyeHeight } = (await probe(page)).calibration;
  expect(eyeHeight).toBeGreaterThan(1.74);
  expect(eyeHeight).toBeLessThan(1.86);

  await load(page, withHeadset);
  const after = (await probe(page)).calibration;
  expect(after.eyeHeight).toBeCloseTo(eyeHeight, 3);
  expect(after.armSpan).toBeCloseTo(armSpanFromFingertipSpan(1.6), 3);
  await expect(page.getByRole('spinbutton', { name: 'Height in centimetres' })).toHaveValue('192');

  await page.getByRole('button', { name: 'Reset calibration' }).click();
  await expect.poll(async () => (await probe(page)).calibration.eyeHeight).toBeCloseTo(before.eyeHeight, 3);
});

test('by hand: what no person measures is refused where it is typed @full', async ({ page }) => {
  await openWithHeadset(page);
  const before = (await probe(page)).calibration;
  const height = page.getByRole('spinbutton', { name: 'Height in centimetres' });
  await height.fill('1800');
  await page.keyboard.press('Tab');
  expect(await height.evaluate((input: HTMLInputElement) => input.validity.valid)).toBe(false);
  expect((await probe(page)).calibration).toEqual(before);
});

test('a typed forearm divides the arm, outlasts calibration and reload, and is forgotten when emptied @full', async ({
  page,
}) => {
  const headset = await openWithHeadset(page, 'estimator=ik');
  const forearm = page.getByRole('spinbutton', { name: 'Forearm in centimetres' });
  const told = async () => (await probe(page)).calibration.forearm;
  await expect(forearm).toHaveValue('');
  await forearm.fill('45');
  await page.keyboard.press('Tab');
  expect(await forearm.evaluate((input: HTMLInputElement) => input.validity.valid)).toBe(false);
  await forearm.fill('38');
  await page.keyboard.press('Tab');
  await expect(page.getByText(/A forearm of 0\.38 m does not match an arm span of/)).toBeVisible();
  expect(await told()).toBeUndefined();
  await forearm.fill('25');
  await page.keyboard.press('Tab');
  await expect.poll(told).toBe(0.25);

  await headset.place(armsAhead);
  await page.getByRole('button', { name: 'Calibrate', exact: true }).click();
  const dialog = page.getByRole('dialog', { name: 'Calibrate' });
  await expect(dialog.getByRole('status')).toHaveText('Done', { timeout: 30_000 });
  await dialog.getByRole('button', { name: 'Close' }).click();
  expect((await probe(page)).calibration.handTilts).toBeDefined();
  expect(await told()).toBe(0.25);

  await load(page, withHeadset);
  expect(await told()).toBe(0.25);
  await forearm.fill('');
  await page.keyboard.press('Tab');
  await expect.poll(told).toBeUndefined();
  expect((await probe(page)).calibration.handTilts).toBeDefined();
});

test('guided: standing still with the arms stretched forward measures the person, and it is remembered', async ({
  page,
}) => {
  const headset = await openWithHeadset(page, 'estimator=ik');
  await headset.place(armsAhead);
  await page.getByRole('button', { name: 'Calibrate', exact: true }).click();
  const dialog = page.getByRole('dialog', { name: 'Calibrate' });
  await expect(dialog).toBeVisible();
  await expect(dialog.getByRole('status')).toHaveText('Done', { timeout: 30_000 });
  const { calibration } = await probe(page);
  expect(calibration.eyeHeight).toBeCloseTo(1.72, 2);
  expect(calibration.armSpan).toBeGreaterThan(1.3);
  expect(calibration.armSpan).toBeLessThan(1.8);
  await dialog.getByRole('button', { name: 'Close' }).click();

  await load(page, withHeadset);
  expect((await probe(page)).calibration.eyeHeight).toBeCloseTo(1.72, 2);
});

// The emulator's panel begins a session with the head where it was when the panel came: in pages of their own, where
// the test puts it.
freshTest(
  'worn: a person who never calibrated and then stands up straight grows, and the page says why @full',
  async ({ page }) => {
    const headset = await openWithHeadset(page, 'estimator=ik');
    const stand = (height: number) =>
      headset.place({ head: { position: [0.2, height, 0], orientation: [0, 0, 0, 1] } });
    const eyeHeight = async () => (await probe(page)).calibration.eyeHeight;
    await stand(1.5);
    await enterVr(page);
    await expect.poll(eyeHeight).toBeCloseTo(1.5, 2);
    await stand(1.57);
    await expect.poll(eyeHeight).toBeCloseTo(1.57, 2);
    await headset.endSession();
    await expect(page.getByText('corrected, because you stood taller')).toBeVisible();
  },
);

freshTest(
  'worn: a person who typed a height and stands taller is told, and keeps the body that they asked for @full',
  async ({ page }) => {
    const headset = await openWithHeadset(page, 'estimator=ik');
    await page.getByRole('spinbutton', { name: 'Height in centimetres' }).fill('165');
    await page.keyboard.press('Tab');
    await expect.poll(async () => (await probe(page)).calibration.eyeHeight).toBeCloseTo(1.54, 1);
    const typed = (await probe(page)).calibration;
    const stand = (height: number) =>
      headset.place({ head: { position: [0.2, height, 0], orientation: [0, 0, 0, 1] } });
    await stand(typed.eyeHeight);
    await enterVr(page);
    await stand(typed.eyeHeight + 0.08);
    await expect(page.getByText(/You stand 8 cm taller than your calibration/)).toBeVisible();
    expect((await probe(page)).calibration).toEqual(typed);
  },
);

test('a grip corrected in the headset’s menu moves the drawn wrist, and the panel remembers it', async ({ page }) => {
  await page.addInitScript(recordCanvasText);
  const headset = await openWithHeadset(page, 'estimator=ik');
  await enterVr(page);
  await headset.place({ ...armsAhead, head: lookingAtMenu });
  await pressInMenu(page, 'My grip');
  await keepPicture(page, 'grip-in-menu');
  const left = await settledJoint(page, 'leftHand');
  await pressInMenu(page, 'Forward');
  await waitForCanvasText(page, '+5 mm');
  // The left hand, level and palm inwards, moves along its fingers.
  await expect.poll(async () => distance(await joint(page, 'leftHand'), left)).toBeCloseTo(0.005, 3);
  await page.getByRole('button', { name: 'Controls' }).click();
  await expect(page.locator('#emulator')).toBeVisible();
  expect(await overlap(page, '.panel', '#emulator')).toBe(false);
  await expect(page.getByText('controllers “Meta Quest Touch Plus”.')).toBeVisible();
  const forward = page.getByRole('group', { name: 'Move: Back, Forward' });
  await expect(forward.getByRole('status')).toHaveText('+5 mm');
  await headset.endSession();
  await forward.getByRole('button', { name: 'Forward' }).click();
  await load(page, withHeadset);
  await expect(forward.getByRole('status')).toHaveText('+10 mm');
  await page.getByRole('button', { name: 'Reset grip' }).click();
  await expect(forward.getByRole('status')).toHaveText('0 mm');
});
