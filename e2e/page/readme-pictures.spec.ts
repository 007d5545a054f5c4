import { actorFrame, defaultCalibration } from 'threepoint/core';
import { exportMotion } from 'threepoint/motion';
import type { ArcheryProbe } from '../../src/page/archery/archery-play';
import type { BallActivityProbe } from '../../src/page/ball/ball-activity';
import { driveTime, holdAt, pass, rest } from '../driven-time';
import { keepFilm } from '../film';
import { card, choose, errors } from '../mocap-card';
import { expect, freshTest, keepPicture, open, test } from '../page-fixture';
import { downloaded, recordTheActor } from '../recorded-actor';

// The pictures of README.md as the page shows them now. `npm run tool -- pictures` puts them into docs/images.
test.use({ viewport: { width: 1280, height: 720 } });
freshTest.use({ viewport: { width: 1280, height: 720 } });

const patience = { timeout: 240_000, intervals: [0] };

test.beforeEach(() => test.setTimeout(600_000));

test('archery: an archer at full draw, one target hit @nightly', async ({ page }) => {
  await open(page, 'play=archery&seed=7&quality=high&panel=off');
  await driveTime(page);
  await holdAt<ArcheryProbe>(page, { score: 5 });
  await expect
    .poll(async () => {
      await pass(page, 2);
      return page.getByText('Fully drawn').isVisible();
    }, patience)
    .toBe(true);
  await keepPicture(page, 'readme-archery');
});

test('the picture of motion capture shows our actor’s file by two methods, each with the truth @nightly', async ({
  page,
}) => {
  await recordTheActor(page, 4);
  const { bytes } = await downloaded(page, 'BVH');
  await open(page, 'emulate&quality=high&estimator=learned&actor=off');
  await choose(page, [{ name: 'actor.bvh', mimeType: 'text/plain', buffer: bytes }]);
  await card(page).getByRole('button', { name: 'Pause' }).click(patience);
  await card(page).getByLabel('Time of the clip').fill('1.5');
  await card(page).getByLabel('Compared with').selectOption('paper');
  // Until its network has answered for this moment and the seconds before, a method draws inverse kinematics: then its
  // figures stay.
  let last = '';
  let stayed = 0;
  await expect
    .poll(async () => {
      const now = (await errors(page, 'Mean')).join(' ');
      stayed = now === last && !now.includes('NaN') ? stayed + 1 : 0;
      last = now;
      return stayed;
    }, patience)
    .toBeGreaterThan(30);
  await page.getByRole('button', { name: 'Controls' }).click();
  await keepPicture(page, 'readme-motion-in');
});

test.describe('moving pictures', () => {
  test.use({ viewport: { width: 960, height: 540 } });

  test('the mirror: a person and the reflection @nightly', async ({ page }) => {
    await open(page, 'quality=high&panel=off&view=third-person');
    await driveTime(page);
    await keepFilm(page, 'film-mirror', 5, 640);
  });

  test('archery: a round of the built-in archer @nightly', async ({ page }) => {
    await open(page, 'play=archery&seed=7&quality=high&panel=off');
    await driveTime(page);
    await holdAt<ArcheryProbe>(page, { score: 5 });
    await keepFilm(page, 'film-archery', 5, 640);
  });
});

freshTest('inverse kinematics beside the learned network as a moving picture @nightly', async ({ page }) => {
  freshTest.setTimeout(600_000);
  await page.setViewportSize({ width: 960, height: 540 });
  // The actor puts the hands on the hips, points, folds the arms and boxes.
  const frames = Array.from({ length: 60 * 12 }, (_, row) => ({
    ...actorFrame(5 + row / 60, defaultCalibration),
    time: row / 60,
  }));
  const recording = { device: 'actor', rateHz: 60, calibration: defaultCalibration, frames };
  const { parts } = await exportMotion(recording, { format: 'bvh', estimator: 'ik' });
  await page.route('**/actor.bvh', (route) => route.fulfill({ body: parts.join('') }));
  await open(page, 'mocap=actor.bvh&estimator=learned&beside=ik&truth=off&quality=high&panel=off&view=front');
  await card(page).getByRole('button', { name: 'More' }).click();
  await expect(card(page).getByLabel('Compared with')).toHaveValue('ik');
  await rest(page);
  await card(page).getByLabel('Time of the clip').fill('0.5');
  // The camera steps back, and the picture has the two bodies alone.
  const stage = page.locator('#stage');
  for (let steps = 0; steps < 5; steps++) await stage.press('-');
  await stage.blur();
  await page.addStyleTag({ content: 'body > :not(main) { display: none !important }' });
  await keepFilm(page, 'film-methods', 7, 640);
});

// A page of its own, from a server with rooms: a host without them says so.
freshTest('the ball game as a moving picture @nightly', async ({ page, serve }) => {
  freshTest.setTimeout(600_000);
  await page.setViewportSize({ width: 960, height: 540 });
  const { origin } = await serve();
  await page.goto(`${origin}/?play=ball&panel=off&quality=high&estimator=ik&seed=5`);
  // Driven frames leave no time to a request: the server answers before they start.
  await expect(page.getByRole('button', { name: 'Play with others' })).toBeEnabled({ timeout: 120_000 });
  await driveTime(page);
  await holdAt<BallActivityProbe>(page, { phase: 'running', score: 1 });
  await keepFilm(page, 'film-ball', 5, 640);
});

freshTest('archery on a phone as a moving picture @nightly', async ({ page }) => {
  freshTest.setTimeout(600_000);
  await page.setViewportSize({ width: 390, height: 844 });
  await open(page, 'play=archery&seed=7&quality=low&panel=off');
  await driveTime(page);
  await holdAt<ArcheryProbe>(page, { score: 5 });
  await keepFilm(page, 'film-phone', 4, 300);
});
