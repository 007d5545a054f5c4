import type { Page } from '@playwright/test';
import { frames } from '../emulated-headset';
import { type EmulatedRoom, installRoom } from '../emulated-room';
import { expect, keepPicture, openWithHeadset, probe, freshTest as test } from '../page-fixture';
import { lookingAtMenu, pressInMenu, recordCanvasText, waitForCanvasText } from './hands-on-menu';

const livingRoom: EmulatedRoom = { floorHeight: 0.04, halfWidth: 2, ahead: 3, behind: 1.5 };
const hall: EmulatedRoom = { floorHeight: 0, halfWidth: 5, ahead: 14, behind: 4 };

/** Enters a session in a room of the emulated headset. */
async function enterRoom(page: Page, room: EmulatedRoom, query = '') {
  const headset = await openWithHeadset(page, `estimator=ik&panel=off${query}`);
  await headset.place({ head: { position: [0, 1.6, 0] } });
  await installRoom(page, room);
  await page.getByRole('button', { name: 'Enter AR' }).click();
  await expect.poll(async () => (await probe(page)).passthrough, { timeout: 90_000 }).not.toBeNull();
  return headset;
}

const passthrough = async (page: Page) => (await probe(page)).passthrough;

test('the mirror stands on the real floor, is moved and anchored, and the studio is gone @full', async ({ page }) => {
  const headset = await enterRoom(page, livingRoom);
  await expect(page.getByRole('button', { name: 'Exit AR' })).toBeVisible();
  await expect.poll(async () => (await passthrough(page))?.anchored).toBe(true);
  const before = (await passthrough(page))!;
  expect(before.showsRoom).toBe(true);
  expect(before.mirror.y).toBeCloseTo(0.04, 3);
  expect(Math.hypot(before.mirror.x, before.mirror.z)).toBeLessThan(2.6);
  await headset.place({ head: { position: [0.3, 1.6, 0.2] }, left: { position: [-0.3, 1.3, -0.3] } });
  await frames(page, 10);
  await keepPicture(page, 'passthrough-mirror');
  // The right controller grabs the mirror, turns to the left and lets go.
  await headset.place({ right: { position: [0.2, 1.2, -0.3], orientation: [0, 0, 0, 1] } });
  await frames(page, 3);
  const squeeze = (value: number) =>
    page.evaluate((pressed) => window.emulatedDevice.controllers.right.updateButtonValue('squeeze', pressed), value);
  await squeeze(1);
  await frames(page, 3);
  await headset.place({ right: { position: [0.2, 1.2, -0.3], orientation: [0, 0.3826834, 0, 0.9238795] } });
  await expect.poll(async () => (await passthrough(page))?.mirror.x).toBeLessThan(-0.8);
  await squeeze(0);
  await expect.poll(async () => (await passthrough(page))?.anchored).toBe(true);
  await headset.place({ right: { position: [0.3, 1, -0.3], orientation: [0, 0, 0, 1] } });
  await frames(page, 5);
  expect((await passthrough(page))?.mirror.x).toBeLessThan(-0.8);
  await keepPicture(page, 'passthrough-mirror-moved');

  await headset.endSession();
  await expect.poll(async () => (await probe(page)).activity).toBe('desktop');
  expect(await passthrough(page)).toBeNull();
  await frames(page, 5);
  await keepPicture(page, 'passthrough-left');
});

test('the avatar stands beside its user by a button of the menu, whole, and goes back @full', async ({ page }) => {
  await page.addInitScript(recordCanvasText);
  const headset = await enterRoom(page, livingRoom);
  await headset.place({ head: lookingAtMenu });
  await pressInMenu(page, 'Stand beside yourself');
  await waitForCanvasText(page, 'Back into your body');
  // From 1.2 m beside it, and half a metre behind.
  await headset.place({ head: { position: [0, 1.6, 0.6], orientation: [0, -0.5, 0, 0.8660254] } });
  await frames(page, 10);
  await keepPicture(page, 'passthrough-beside');
  await headset.place({ head: lookingAtMenu });
  await pressInMenu(page, 'Back into your body');
  await waitForCanvasText(page, 'Stand beside yourself');
});

test('a picture of the shadow on the real floor, in high quality @nightly', async ({ page }) => {
  test.setTimeout(300_000);
  // Software draws this quality slowly: the window is small.
  await page.setViewportSize({ width: 480, height: 300 });
  const headset = await enterRoom(page, { ...livingRoom, floorHeight: 0 }, '&quality=high');
  await expect.poll(async () => (await passthrough(page))?.anchored, { timeout: 120_000 }).toBe(true);
  await headset.place({ head: { position: [0, 1.6, 0], orientation: [-0.4, 0, 0, 0.9165] } });
  await frames(page, 6);
  await keepPicture(page, 'passthrough-shadow');
});

test('archery stands in a hall at its true distances; a living room gets the usual world @full', async ({ page }) => {
  test.setTimeout(120_000);
  const headset = await enterRoom(page, hall, '&play=archery&seed=7');
  await expect.poll(async () => (await passthrough(page))?.showsRoom).toBe(true);
  await frames(page, 10);
  await keepPicture(page, 'passthrough-archery');
  await headset.endSession();
  await expect.poll(async () => (await probe(page)).activity).toBe('desktop');
  await installRoom(page, livingRoom);
  await page.getByRole('button', { name: 'Enter AR' }).click();
  await expect.poll(async () => (await passthrough(page))?.showsRoom).toBe(false);
  expect((await probe(page)).notices.map(({ text }) => text).join()).toContain(
    'The archery range needs 5 × 11.5 m of free floor in front of you. Your room is smaller, so the usual world is shown.',
  );
  await frames(page, 10);
  await keepPicture(page, 'passthrough-archery-usual');
});

test('the ball court stands in a hall, without sky, ground and hills @full', async ({ page }) => {
  test.setTimeout(120_000);
  await enterRoom(page, hall, '&play=ball&seed=5');
  await expect.poll(async () => (await passthrough(page))?.showsRoom, { timeout: 60_000 }).toBe(true);
  await frames(page, 10);
  await keepPicture(page, 'passthrough-ball');
});

test('a page that enters VR loads nothing of passthrough @full', async ({ page }) => {
  const loaded: string[] = [];
  page.on('request', (request) => loaded.push(request.url()));
  await openWithHeadset(page, 'estimator=ik&panel=off');
  await page.getByRole('button', { name: 'Enter VR' }).click();
  await expect.poll(async () => (await probe(page)).activity).toBe('vr');
  expect(loaded.filter((url) => url.includes('passthrough'))).toEqual([]);
  expect(await passthrough(page)).toBeNull();
});
