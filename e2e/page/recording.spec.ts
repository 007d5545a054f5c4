import type { Page } from '@playwright/test';
import { validateBytes } from 'gltf-validator';
import { expect, joint, open, probe, test } from '../page-fixture';
import { downloaded, recordTheActor } from '../recorded-actor';

// In full one that asks a network and one that asks none, the others by night.
const replays = {
  '@full': [
    ['Hands only', 'hands-only'],
    ['Learned', 'learned'],
  ],
  '@nightly': [
    ['Inverse kinematics', 'ik'],
    ['Paper', 'paper'],
  ],
} as const;
for (const [suite, estimators] of Object.entries(replays)) {
  const names = estimators.map(([, name]) => name).join(' and ');
  test(`a recording keeps full precision and replays through ${names} ${suite}`, async ({ page }) => {
    await recordTheActor(page);
    const text = (await downloaded(page, 'Download')).bytes.toString('utf8');
    const digits = [...text.matchAll(/-?\d\.(\d+)/g)].map(([, decimals = '']) => decimals.length);
    expect(Math.max(...digits)).toBeGreaterThan(5);

    for (const [label, name] of estimators) {
      await open(page, 'emulate&quality=low&actor=off');
      await page.getByRole('radio', { name: label, exact: true }).check();
      await expect.poll(async () => (await probe(page)).estimator).toBe(name);
      await page.getByRole('tab', { name: 'Recording' }).click();
      await page
        .getByLabel('Open recording')
        .and(page.locator('input'))
        .setInputFiles({ name: 'mine.json', mimeType: 'application/json', buffer: Buffer.from(text) });
      const replay = page.getByRole('button', { name: 'Replay' });
      if ((await probe(page)).recorder.mode !== 'replaying') await replay.click();
      await expect.poll(async () => (await probe(page)).recorder.mode).toBe('replaying');
      const before = await joint(page, 'leftHand');
      await expect
        .poll(async () => {
          const now = await joint(page, 'leftHand');
          return Math.hypot(now[0] - before[0], now[1] - before[1], now[2] - before[2]);
        })
        .toBeGreaterThan(0.005);
      expect((await probe(page)).estimator).toBe(name);
    }
  });
}

test('a file that is no recording is refused in a sentence', async ({ page, complaints }) => {
  complaints.allow(/recording/i);
  await open(page, 'emulate&quality=low&actor=off');
  await page.getByRole('tab', { name: 'Recording' }).click();
  await page
    .getByLabel('Open recording')
    .and(page.locator('input'))
    .setInputFiles({ name: 'holiday.json', mimeType: 'application/json', buffer: Buffer.from('{"photos": []}') });
  await expect(page.getByRole('alert')).toContainText('holiday.json');
});

test('a recording becomes files for other programs, drawn by the chosen method @full', async ({ page, complaints }) => {
  complaints.allow(/could not be exported/);
  await recordTheActor(page);
  const bvh = await downloaded(page, 'BVH');
  expect(bvh.name).toBe('recording-1-ik.bvh');
  const text = bvh.bytes.toString('utf8');
  expect(Number(/^Frames: (\d+)$/m.exec(text)?.[1])).toBeGreaterThan(30);
  expect(text).toContain('JOINT leftIndexDistal');

  for (const [button, ending] of [
    ['VRM Animation', 'vrma'],
    ['Avatar (GLB)', 'glb'],
  ] as const) {
    const { name, bytes } = await downloaded(page, button);
    expect(name).toBe(`recording-1-ik.${ending}`);
    const { issues } = await validateBytes(new Uint8Array(bytes), { format: 'glb' });
    expect(issues.messages.filter(({ severity }) => severity === 0)).toEqual([]);
  }
  const csv = await downloaded(page, 'Table (CSV)');
  expect(csv.bytes.toString('utf8').trimEnd().split('\n').length).toBeGreaterThan(5);

  await page.getByRole('tab', { name: 'Body' }).click();
  await page.getByRole('radio', { name: 'Hands only' }).check();
  await page.getByRole('tab', { name: 'Recording' }).click();
  await page.getByRole('button', { name: 'BVH', exact: true }).click();
  await expect(page.getByRole('alert')).toContainText('recording-1 could not be exported');
});

/** A recording of the actor is at the address walk.json from now on. */
async function serveTheActor(page: Page): Promise<void> {
  await recordTheActor(page);
  const { bytes: body } = await downloaded(page, 'Download');
  await page.route('**/walk.json', (route) => route.fulfill({ body, contentType: 'application/json' }));
}

test('a recording in the address is replayed on the range too, whichever of them comes first @full', async ({
  page,
}) => {
  await serveTheActor(page);
  await open(page, 'play=archery&replay=walk.json&panel=off&quality=low&estimator=ik');
  await expect(page.getByRole('button', { name: 'Archery' })).toHaveAttribute('aria-pressed', 'true');
  await expect.poll(async () => (await probe(page)).recorder.mode).toBe('replaying');
});

test('a recording replaying on the range leaves the bow to mouse and built-in archer on request @full', async ({
  page,
}) => {
  await serveTheActor(page);
  await open(page, 'play=archery&replay=walk.json&quality=low&estimator=ik&panel=on');
  const [shoot, watch] = ['Shoot with the mouse', 'Watch'].map((name) => page.getByRole('button', { name }));
  const mode = async () => (await probe(page)).recorder.mode;
  for (const choice of [shoot!, watch!]) {
    await expect.poll(mode).toBe('replaying');
    await expect(shoot!).toBeEnabled();
    await expect(watch!).toBeEnabled();
    await choice.click();
    expect(await mode()).toBe('idle');
    await expect(choice).toBeDisabled();
    await page.getByRole('tab', { name: 'Recording' }).click();
    await page.getByRole('button', { name: 'Replay', exact: true }).click();
  }
});
