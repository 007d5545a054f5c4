import type { Page } from '@playwright/test';
import { archeryRules } from 'threepoint-games/archery';
import { stations } from 'threepoint-games/ball';
import { type EmulatedHeadset, frames, type Point } from '../emulated-headset';
import { enterVr, expect, gameOn, keepPicture, openWithHeadset, probe, freshTest as test } from '../page-fixture';
import { recordCanvasText } from './hands-on-menu';
import { inLobby, inMenu, pinchAt, pinchByEyes, pointingFrom } from './without-controllers';

const eyes: Point = [0, 1.6, 0];
/** The targets of the round with this seed, farther than one can miss by a centimetre of eye height. */
const seed = 7;
const targets = archeryRules.start(['archer'], seed, { eyeHeight: 1.6 }).targets;

const target = (index: number): Point => {
  const { x, y, z } = targets[index]!.centre;
  return [x, y, z];
};

const round = (page: Page) => gameOn(page, 'archery');
const match = (page: Page) => gameOn(page, 'ball');

/** Enters VR at the mirror; records what the menu shows. */
async function enter(page: Page): Promise<EmulatedHeadset> {
  await page.addInitScript(recordCanvasText);
  const headset = await openWithHeadset(page, `estimator=ik&panel=off&seed=${seed}`);
  await headset.place({ head: { position: eyes, orientation: [0, 0, 0, 1] } });
  await enterVr(page);
  return headset;
}

const lookAt = (headset: EmulatedHeadset, to: Point) =>
  headset.place({ head: { position: eyes, orientation: pointingFrom(eyes, to) } });

/** Takes a picture of what the headset shows, in real time. */
async function picture(page: Page, name: string): Promise<void> {
  await frames(page, 2);
  await keepPicture(page, name);
}

// No test here depends on how many pixels show it.
test.use({ viewport: { width: 480, height: 300 } });

test('the left bare hand alone goes to archery by the menu, chooses one hand, and shoots @full', async ({ page }) => {
  const headset = await enter(page);
  await headset.useInput('hand');
  await headset.setConnected('right', false);
  const from: Point = [-0.15, 1.3, -0.3];
  const choose = async (label: string) => pinchAt(page, headset, { side: 'left', from, to: await inMenu(page, label) });
  await choose('Archery');
  await expect.poll(async () => (await round(page))?.phase, { timeout: 60_000 }).toBe('ready');
  await choose('Draw: both hands');
  await inMenu(page, 'Draw: one hand');
  // 2 s of the page's time at full draw.
  await pinchAt(page, headset, { side: 'left', from: [-0.1, 1.45, -0.5], to: target(0), held: 80 });
  await expect.poll(async () => (await round(page))?.arrowsLeft).toBe(4);
});

test('pinches that aim by the eyes, as on a Vision Pro, use the menu and shoot @full', async ({ page }) => {
  const headset = await enter(page);
  await pinchByEyes(page);
  const pinch = async (to: Point, held: number) => {
    await headset.place({ right: { position: eyes, orientation: pointingFrom(eyes, to) } });
    await page.evaluate(() => window.eyePinch?.begin());
    await frames(page, held);
    await page.evaluate(() => window.eyePinch?.end());
    await frames(page, 5);
  };
  await frames(page, 50);
  await pinch(await inMenu(page, 'Archery'), 3);
  await expect.poll(async () => (await round(page))?.phase, { timeout: 60_000 }).toBe('ready');
  await frames(page, 50);
  await pinch(target(1), 80);
  await expect.poll(async () => (await round(page))?.hits).toEqual([1]);
  await pinch(await inMenu(page, 'To the mirror'), 3);
  await expect.poll(async () => (await probe(page)).game).toBeNull();
});

test('a user without hands is offered the gaze, and uses menu and both games by it @full', async ({ page }) => {
  const headset = await enter(page);
  for (const side of ['left', 'right'] as const) await headset.setConnected(side, false);
  await frames(page, 150);
  await picture(page, 'gaze-offer');
  // The sign hangs 1.2 m ahead and 0.3 m below the eyes.
  await lookAt(headset, [0, 1.3, -1.2]);
  await frames(page, 70);
  await lookAt(headset, await inMenu(page, 'Archery'));
  await frames(page, 25);
  await picture(page, 'gaze-dwell');
  await expect.poll(async () => (await round(page))?.phase, { timeout: 60_000 }).toBe('ready');
  await lookAt(headset, target(0));
  await expect.poll(async () => (await round(page))?.hits).toEqual([0]);

  await lookAt(headset, await inMenu(page, 'To the mirror'));
  await expect.poll(async () => (await probe(page)).game).toBeNull();
  // The button of archery now lies where the gaze rests, and is not pressed.
  await frames(page, 60);
  await lookAt(headset, await inMenu(page, 'Ball game'));
  await expect.poll(async () => (await match(page))?.phase, { timeout: 60_000 }).toBe('ready');
  await lookAt(headset, await inLobby(page, 'Ready'));
  await expect.poll(async () => (await match(page))?.phase).toBe('running');
  // The first ball is taken without a pointer's action.
  await expect
    .poll(async () => Object.values((await match(page))?.held ?? {}).some((ball) => ball !== null))
    .toBe(true);
  const { basket, seat } = (await match(page))!;
  const station = stations[seat!]!.position;
  await lookAt(headset, [basket[0] - station.x, basket[1], basket[2] - station.z]);
  await frames(page, 30);
  await picture(page, 'gaze-throw');
  await expect.poll(async () => (await match(page))?.caught, { timeout: 40_000 }).toBeGreaterThan(0);

  await lookAt(headset, await inMenu(page, 'Comfort'));
  await inMenu(page, 'Turn left');
  await picture(page, 'comfort-sheet');
  await lookAt(headset, await inMenu(page, 'Raise me'));
  const heightOf = async () => (await probe(page)).tracking?.head[1];
  await expect.poll(heightOf).toBeCloseTo(1.65, 2);
});
