import { rmSync, writeFileSync } from 'node:fs';
import { goldenMocap } from '../../tests/threepoint/core/mocap/golden-mocap';
import { card, choose, errors } from '../mocap-card';
import { expect, keepPicture, load, open, probe, test } from '../page-fixture';

const [acclaim, , leaping, folded] = goldenMocap;
const filesOf = ({ files }: { readonly files: Readonly<Record<string, string>> }) =>
  Object.entries(files).map(([name, text]) => ({ name, mimeType: 'text/plain', buffer: Buffer.from(text) }));

test('motion capture is shown with its truth, and methods are compared on the same second @full', async ({ page }) => {
  await open(page, 'emulate&quality=low&estimator=ik&actor=off');
  await choose(page, filesOf(acclaim!));
  await expect(card(page).getByRole('heading', { name: '11_07' })).toBeVisible();
  expect((await probe(page)).recorder.mode).toBe('replaying');
  await card(page).getByRole('button', { name: 'Pause' }).click();
  await card(page).getByLabel('Time of the clip').fill('0.3');
  await expect.poll(() => errors(page, 'Left elbow')).toEqual([expect.any(Number), expect.any(Number)]);
  await expect.poll(async () => (await errors(page, 'Mean')).every((error) => error > 0 && error < 30)).toBe(true);

  await card(page).getByLabel('Compared with').selectOption('learned');
  await expect.poll(async () => (await errors(page, 'Mean')).filter((error) => error > 0)).toHaveLength(4);
  expect((await probe(page)).recorder.seconds).toBeCloseTo(0.3, 6);
  await keepPicture(page, 'motion-capture');

  await card(page).getByLabel('Method').selectOption('hands-only');
  await expect(card(page)).toContainText('Hands only: it draws no body');

  await page.getByRole('tab', { name: 'Body' }).click();
  await page.getByRole('radio', { name: 'Device' }).check();
  await expect(card(page).getByLabel('Method')).toHaveValue('device');
  await expect(
    card(page)
      .getByLabel('Method')
      .getByRole('option', { name: /Learned is used/ }),
  ).toBeDisabled();
  await expect.poll(async () => (await errors(page, 'Mean')).filter((error) => error > 0)).toHaveLength(4);

  await card(page).getByRole('button', { name: 'Close' }).click();
  await expect(card(page)).toBeHidden();
  expect((await probe(page)).recorder.mode).toBe('idle');
});

test('motion capture leaves a recording that is being made, and says so @full', async ({ page, complaints }) => {
  complaints.allow(/could not be shown/);
  await open(page, 'emulate&quality=low&estimator=ik&actor=off');
  await page.getByRole('tab', { name: 'Recording' }).click();
  await page.getByRole('button', { name: 'Record', exact: true }).click();
  await expect.poll(async () => (await probe(page)).recorder.frames).toBeGreaterThan(0);
  await choose(page, filesOf(acclaim!));
  await expect(page.getByRole('alert')).toContainText('could not be shown: a recording is in progress; stop it first');
  expect((await probe(page)).recorder.mode).toBe('recording');
  await expect(card(page)).toBeHidden();
  await page.getByRole('button', { name: 'Stop', exact: true }).click();
});

test('a method chosen beside motion capture is remembered as one chosen in the panel is @full', async ({ page }) => {
  await open(page, 'emulate&quality=low&estimator=ik&actor=off');
  await choose(page, filesOf(acclaim!));
  await card(page).getByLabel('Method').selectOption('hands-only');
  await expect.poll(async () => (await probe(page)).estimator).toBe('hands-only');
  await load(page, 'emulate&quality=low&actor=off');
  expect((await probe(page)).estimator).toBe('hands-only');
});

test('a link leads to the same second, method and body beside it @full', async ({ page }) => {
  for (const [name, text] of Object.entries(leaping!.files))
    await page.route(`**/clips/${name}`, (route) => route.fulfill({ body: text, contentType: 'text/plain' }));
  await open(
    page,
    'emulate&quality=low&estimator=ik&mocap=clips/someone_walks.bvh&clip=1&at=0.25&beside=ik&truth=beside',
  );
  await expect(card(page).getByRole('heading', { name: 'someone_walks#1' })).toBeVisible();
  await expect(card(page).getByLabel('Compared with')).toHaveValue('ik');
  await expect(card(page).getByLabel('Truth')).toHaveValue('beside');
  expect((await probe(page)).recorder.seconds).toBe(0.25);
  const loaded = /^someone_walks\.bvh is open: one person, \d+\.\d s at \d+ Hz in 2 pieces\./;
  await expect(page.getByRole('status').filter({ hasText: loaded })).toBeVisible();
  await expect(card(page)).toContainText('It leaps at frame 39; cut there.');

  await card(page).getByLabel('Clip', { exact: true }).selectOption('someone_walks#2');
  await card(page).getByRole('button', { name: 'Pause' }).click();
  await card(page).getByLabel('Time of the clip').fill('0.5');
  await card(page).getByRole('button', { name: 'Copy link' }).click();
  const link = new URL(page.url()).searchParams;
  expect(link.get('mocap')).toBe('clips/someone_walks.bvh');
  expect([link.get('clip'), link.get('beside'), link.get('estimator')]).toEqual(['2', 'ik', 'ik']);
  expect(Number(link.get('at'))).toBe(0.5);

  await card(page).getByRole('button', { name: 'Less' }).click();
  await expect(card(page).getByLabel('Method')).toHaveCount(0);
  await expect(card(page).getByLabel('Time of the clip')).toBeVisible();
  await page.getByRole('button', { name: 'Archery' }).click();
  await expect(card(page)).toBeHidden();
  const input = page.getByLabel('Open motion capture').and(page.locator('input'));
  await input.setInputFiles(filesOf(acclaim!));
  await expect(page.getByRole('button', { name: 'Mirror' })).toHaveAttribute('aria-pressed', 'true');
  await expect(card(page)).toBeVisible();
});

test('the pieces of another file with as many of them can be chosen @full', async ({ page }) => {
  await open(page, 'emulate&quality=low&estimator=ik&actor=off');
  const [motion] = filesOf(leaping!);
  const pieces = card(page).getByLabel('Clip', { exact: true }).getByRole('option');
  await choose(page, [motion!]);
  await expect(pieces).toHaveText(['someone_walks#1', 'someone_walks#2']);
  await choose(page, [{ ...motion!, name: 'another_walks.bvh' }]);
  await expect(pieces).toHaveText(['another_walks#1', 'another_walks#2']);
});

test('a clip that was stopped is played again by its own button @full', async ({ page }) => {
  await open(page, 'emulate&quality=low&estimator=ik&actor=off');
  await choose(page, filesOf(acclaim!));
  await expect(card(page).getByRole('heading', { name: '11_07' })).toBeVisible();
  await page.getByRole('button', { name: 'Stop' }).click();
  expect((await probe(page)).recorder.mode).toBe('idle');
  await card(page).getByRole('button', { name: 'Play' }).click();
  expect((await probe(page)).recorder.mode).toBe('replaying');
  await expect(card(page).getByRole('button', { name: 'Pause' })).toBeVisible();
});

test('a damaged file is refused with line and column, and what is shown stays', async ({ page, complaints }) => {
  complaints.allow(/could not be shown/);
  await open(page, 'emulate&quality=low&estimator=ik&actor=off');
  await choose(page, filesOf(leaping!));
  const heading = card(page).getByRole('heading', { name: /someone_walks#/ });
  await expect(heading).toBeVisible();
  const broken = leaping!.files['someone_walks.bvh']!.replace('MOTION\n', 'MOTION\nNaN ');
  await choose(page, [{ name: 'broken.bvh', mimeType: '', buffer: Buffer.from(broken) }]);
  await expect(page.getByRole('alert')).toContainText(/broken\.bvh could not be shown: line \d+, column \d+: /);
  await expect(heading).toBeVisible();
});

test('bones that names contradict are mapped by hand or JSON, remembered, corrected and forgotten @full', async ({
  page,
}) => {
  await page.setViewportSize({ width: 960, height: 760 });
  await open(page, 'emulate&quality=low&estimator=ik&actor=off');
  const contradicted = Object.entries(folded!.files).map(([name, text]) => [
    name,
    text.replaceAll('bip_LeftHand', 'bip_LeftKnee'),
  ]);
  const files = filesOf({ ...folded!, files: Object.fromEntries(contradicted) });
  const [motion, map] = files.toSorted((a, b) => a.name.localeCompare(b.name));
  const heading = card(page).getByRole('heading', { name: 'folded_1' });
  const form = card(page).getByRole('region', { name: 'Bones of this file' });
  const bone = form.getByRole('option', { name: /^bip_LeftKnee:/ });
  const correct = card(page).getByRole('button', { name: 'Correct the bones…' });
  const use = form.getByRole('button', { name: 'Use these bones' });

  await choose(page, [motion!]);
  await expect(form).toBeFocused();
  await expect(form).toContainText('bones of folded_1.bvh could not be matched to a humanoid.');
  await use.click();
  await expect(form.getByRole('alert')).toHaveText('Still missing: left hand.');
  await keepPicture(page, 'motion-bones-asked');
  // The keyboard goes from bone to bone, and its part is chosen from the list.
  await form.getByRole('option').first().focus();
  await page.keyboard.press('End');
  for (let steps = 0; steps < 40 && (await bone.getAttribute('aria-selected')) !== 'true'; steps++)
    await page.keyboard.press('ArrowUp');
  await form.getByLabel('bip_LeftKnee is').selectOption('Left hand');
  await page.setViewportSize({ width: 390, height: 844 });
  await form.getByRole('heading').scrollIntoViewIfNeeded();
  await keepPicture(page, 'motion-bones-phone');
  await page.setViewportSize({ width: 960, height: 760 });
  await use.click();
  await expect(heading).toBeVisible();
  await keepPicture(page, 'motion-bones-given');

  await load(page, 'emulate&quality=low&estimator=ik&actor=off');
  await choose(page, [motion!]);
  await correct.click();
  await expect(form).toBeFocused();
  await keepPicture(page, 'motion-bones-correcting');
  await form.getByRole('button', { name: 'Cancel' }).click();
  await expect(correct).toBeFocused();
  await correct.click();
  await form.getByRole('button', { name: 'Forget my map' }).click();
  await expect(form.getByRole('button', { name: 'Left hand: missing' })).toBeVisible();

  await choose(page, [map!]);
  await expect(heading).toBeVisible();
  await expect(correct).toBeHidden();
  await card(page).getByRole('button', { name: 'Close' }).click();
  await choose(page, [map!, motion!]);
  await expect(heading).toBeVisible();
});

test('a large file says how far it is, and given up half-way it leaves nothing behind @full', async ({
  page,
}, testInfo) => {
  const [head, frames] = leaping!.files['someone_walks.bvh']!.split(/Frames: \d+\n/) as [string, string];
  const [time, ...rows] = frames.trimEnd().split('\n');
  const many = Array.from({ length: 3000 }, () => rows.join('\n')).join('\n');
  const path = testInfo.outputPath('large.bvh');
  writeFileSync(path, `${head}Frames: ${3000 * rows.length}\n${time}\n${many}\n`);
  await open(page, 'emulate&quality=low&estimator=ik&actor=off');
  await choose(page, filesOf(acclaim!));
  const heading = card(page).getByRole('heading', { name: '11_07' });
  await expect(heading).toBeVisible();
  const before = { workers: page.workers().length, ...(await probe(page)) };
  expect(before.recorder.mode).toBe('replaying');

  await choose(page, path);
  await expect(card(page)).toContainText(/Reading large\.bvh: [1-9]\d?\s%/);
  expect(page.workers()).toHaveLength(before.workers + 1);
  await card(page).getByRole('button', { name: 'Cancel' }).click();
  await expect(card(page).getByText('Reading')).toBeHidden();
  await expect.poll(() => page.workers().length).toBe(before.workers);
  await expect(heading).toBeVisible();
  const { recorder, notices } = await probe(page);
  expect([recorder.mode, recorder.frames, notices]).toEqual(['replaying', before.recorder.frames, before.notices]);
  rmSync(path);
});
