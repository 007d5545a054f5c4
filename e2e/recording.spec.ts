import { readFileSync } from 'node:fs';
import type { Page } from '@playwright/test';
import { expect, joint, open, probe, test } from './page-fixture';

/** A second and a half of the actor, recorded by the page, as the file that it offers for download. */
async function recordTheActor(page: Page): Promise<string> {
  await open(page, 'emulate&quality=low&estimator=ik');
  await page.getByRole('tab', { name: 'Recording' }).click();
  await page.getByRole('button', { name: 'Record', exact: true }).click();
  await expect.poll(async () => (await probe(page)).recorder.seconds).toBeGreaterThan(1.5);
  await page.getByRole('button', { name: 'Stop' }).click();
  const download = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Download' }).click();
  const path = await (await download).path();
  return readFileSync(path, 'utf8');
}

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
    const text = await recordTheActor(page);
    const digits = [...text.matchAll(/-?\d\.(\d+)/g)].map(([, decimals = '']) => decimals.length);
    expect(Math.max(...digits)).toBeGreaterThan(5);

    for (const [label, name] of estimators) {
      await open(page, 'emulate&quality=low&actor=off');
      await page.getByRole('radio', { name: label }).check();
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
