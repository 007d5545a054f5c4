import { emulatedHeadset, frames } from '../emulated-headset';
import { lookingAtMenu, pressBelow, pressInMenu, recordCanvasText, waitForCanvasText } from '../page/hands-on-menu';
import { enterVr, expect, freshTest, joinedRoom, keepPicture, open, overlap, probe, test } from '../page-fixture';

type Page = Parameters<typeof open>[0];

test.use({ viewport: { width: 900, height: 560 } });
freshTest.use({ viewport: { width: 900, height: 560 } });

const bar = (page: Page) => page.getByRole('region', { name: 'Play' });

test('a newcomer alone reads the rules, what is awaited and a clock standing after the match @full', async ({
  page,
}) => {
  test.setTimeout(180_000);
  await open(page, 'play=ball&panel=off&quality=low&estimator=ik&seed=5&actor=off&emulate&seconds=2');
  await expect(page.getByRole('region', { name: 'Frame time' })).toBeHidden();
  await expect(bar(page)).toContainText('Waiting for you');
  await bar(page).getByText('Players and rules').click();
  await expect(bar(page)).toContainText('a point for every ball that lands in the basket');
  await expect(bar(page)).not.toContainText('Demo');
  await page.getByRole('button', { name: 'Ready', exact: true }).click();
  await expect(bar(page)).toContainText('Waiting for you: press Play again.', { timeout: 90_000 });
  await expect(bar(page).locator('.time:visible')).toHaveText('0 s');
  await keepPicture(page, 'ball-waiting');
});

// A page of its own: it goes on asking this server when the server is gone.
freshTest(
  'a room has a link and a QR code to send; a page whose seat was taken over says so and takes it back @full',
  async ({ page, serve }) => {
    test.setTimeout(240_000);
    const { origin } = await serve();
    await page.goto(`${origin}/?play=ball&panel=off&quality=low&estimator=ik&bots=off`);
    await page.waitForFunction(() => window.threepoint?.probe().game?.name === 'ball', undefined, {
      timeout: 60_000,
    });
    await page.getByRole('button', { name: 'Play with others' }).click();
    const dialog = page.getByRole('dialog', { name: 'Play with others' });
    await expect(dialog.getByRole('img', { name: 'QR code of the link' })).toBeVisible({ timeout: 60_000 });
    const link = await dialog.getByLabel('Link for the others').inputValue();
    expect(link).toMatch(new RegExp(`^${origin}/\\?play=ball&room=[a-z]{6}$`));
    await keepPicture(page, 'ball-invitation');
    await dialog.getByRole('button', { name: 'Close' }).click();
    await joinedRoom(page);
    await expect(bar(page).getByRole('img', { name: 'QR code of the link' })).toBeVisible();
    expect(await bar(page).getByLabel('Link for the others').inputValue()).toBe(link);
    await keepPicture(page, 'ball-waiting-for-others');
    await expect(bar(page)).toContainText(/Connection (good|fair|poor), \d/);

    const pass = await page.evaluate(() => JSON.stringify({ ...sessionStorage }));
    const other = await page.context().newPage();
    await other.addInitScript((kept) => {
      for (const [key, value] of Object.entries(JSON.parse(kept))) sessionStorage.setItem(key, String(value));
    }, pass);
    await other.goto(`${link}&panel=off&quality=low&estimator=ik`);
    await joinedRoom(other);
    await page.bringToFront();
    await expect(bar(page)).toContainText('You opened this room somewhere else');
    await expect(bar(page).getByRole('button', { name: 'Watch' })).toBeDisabled();
    await expect(bar(page).getByRole('button', { name: 'Play with the mouse' })).toBeDisabled();
    for (const covered of ['#masthead h1', '#play', '.panel-bar']) {
      expect(await overlap(page, '#banner', covered), covered).toBe(false);
    }
    await keepPicture(page, 'ball-taken-over');
    await bar(page).getByRole('button', { name: 'Rejoin' }).click();
    await joinedRoom(page);
    await expect(bar(page).getByRole('button', { name: 'Watch' })).toBeEnabled();
    await other.bringToFront();
    await expect(bar(other).getByRole('button', { name: 'Rejoin' })).toBeVisible();

    await other.addInitScript(recordCanvasText);
    await other.goto(`${link}&panel=off&quality=low&estimator=ik&emulate&actor=off`);
    await joinedRoom(other);
    await (await emulatedHeadset(other)).place({ head: lookingAtMenu });
    await enterVr(other, { stepMs: null });
    await pressInMenu(other, 'Invite');
    await waitForCanvasText(other, link.slice(link.indexOf('?')));
    await keepPicture(other, 'ball-invitation-vr');
    await other.close();
  },
);

freshTest('in the headset another player is hidden by the menu, and shown again @full', async ({ page }) => {
  test.setTimeout(240_000);
  await page.addInitScript(recordCanvasText);
  await open(page, 'play=ball&panel=off&quality=low&estimator=ik&seed=5&emulate&actor=off');
  const drawn = async () =>
    (await probe(page)).players.map(({ name, drawnAs }) => `${name}: ${drawnAs === null ? 'hidden' : 'drawn'}`).sort();
  await expect.poll(drawn).toEqual(['Kim: drawn', 'Max: drawn']);
  const headset = await emulatedHeadset(page);
  await headset.place({ head: lookingAtMenu });
  await enterVr(page, { stepMs: null });
  await pressInMenu(page, 'Players');
  await pressBelow(page, 'Kim (bot)', 'Hide');
  await expect.poll(drawn).toEqual(['Kim: hidden', 'Max: drawn']);
  await keepPicture(page, 'ball-players-vr');
  await headset.place({ head: { position: [0, 1.6, 0], orientation: [0, 0, 0, 1] } });
  await frames(page, 3);
  await keepPicture(page, 'ball-hidden-vr');
  await pressBelow(page, 'Kim (bot)', 'Show');
  await expect.poll(drawn).toEqual(['Kim: drawn', 'Max: drawn']);
});

test('between a room and the open controls the button that enters VR is read whole @full', async ({ page }) => {
  await open(page, 'play=ball&quality=low&estimator=ik&seed=5&actor=off');
  await page.setViewportSize({ width: 1280, height: 720 });
  const controls = page.getByRole('button', { name: 'Controls' });
  if ((await controls.getAttribute('aria-expanded')) === 'false') await controls.click();
  for (const [width, height] of [
    [1280, 720],
    [960, 600],
    [901, 700],
  ]) {
    await page.setViewportSize({ width: width!, height: height! });
    for (const beside of ['#play .round:not([hidden])', '.panel']) {
      expect(await overlap(page, 'button.enter', beside), `${width} × ${height}: ${beside}`).toBe(false);
    }
  }
  // If there is no space for both, the controls take the place of the room until they are closed.
  await page.setViewportSize({ width: 780, height: 600 });
  await expect(page.locator('#play .round')).toBeHidden();
  await expect(page.locator('button.enter')).toBeVisible();
  await controls.click();
  await expect(page.locator('button.enter')).toBeVisible();
  expect(await overlap(page, 'button.enter', '#play .round:not([hidden])')).toBe(false);
});

test('nothing lies over the name, the places or Centre at 900 × 560', async ({ page }) => {
  await open(page, 'quality=low&estimator=ik&avatar=');
  // The open controls take the place of the line below the name.
  await expect(page.locator('#masthead p')).toBeHidden();
  expect(await overlap(page, '#play', '#masthead h1')).toBe(false);
  const { joints } = (await probe(page)).avatar;
  expect(Object.keys(joints).length).toBeGreaterThan(10);
  for (const covered of ['#masthead h1', '#play', '.panel-bar']) {
    expect(await overlap(page, '.notice', covered), covered).toBe(false);
  }
  await keepPicture(page, 'low-window');
});
