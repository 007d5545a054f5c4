import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import type { Page } from '@playwright/test';
import { endDrivenTime, pass } from '../driven-time';
import { emulatedHeadset } from '../emulated-headset';
import { enterVr, expect, keepPicture, open, probe, freshTest as test } from '../page-fixture';
import { bundlePolyfill } from '../polyfill-bundle';

/**
 * The page with the measures of a person, on an emulated headset that tracks bodies as inverse kinematics draws them.
 */
async function openOnTrackingHeadset(page: Page): Promise<void> {
  await open(page, 'emulate&quality=low&estimator=ik');
  await emulatedHeadset(page);
  await page.getByLabel('Height in centimetres').fill('172');
  await page.getByLabel('Arm span in centimetres').fill('170');
  await page.getByLabel('Arm span in centimetres').blur();
  const { calibration } = await probe(page);
  const options = JSON.stringify({ estimator: 'ik', calibration });
  await page.evaluate(`${await bundlePolyfill()}; bodyPolyfill.installBodyTracking(${options}); null`);
}

/** What `npm run tool -- evaluate --recording` says of the only recording. */
function evaluated(recording: string, json: string) {
  const root = fileURLToPath(new URL('../..', import.meta.url));
  const request = JSON.stringify({ recording: [recording], models: 'public/models', json });
  execFileSync(process.execPath, ['--import', 'tsx', 'bench/evaluate/recorded.ts', request], { cwd: root });
  const [only] = Object.values(JSON.parse(readFileSync(json, 'utf8')).recordings);
  return only as { frames: number; estimators: Record<string, { mpjpeCm: { mean: number; median: number } }> };
}

const askSwitch = (page: Page) => page.getByRole('switch', { name: 'Use the headset’s body tracking' });
/** Presses what may lie below the emulator's picture, or on a page of the panel that is not shown. */
const press = (page: Page, role: 'button' | 'radio', name: string) =>
  page.getByRole(role, { name, exact: true, includeHidden: true }).dispatchEvent('click');

test('a headset’s own body is requested by wish alone, drawn, compared, recorded, and evaluated as truth @full', async ({
  page,
}, testInfo) => {
  await openOnTrackingHeadset(page);
  await expect(askSwitch(page)).not.toBeChecked();
  await askSwitch(page).check();
  await page.keyboard.press('o');
  await keepPicture(page, 'device-body-panel');

  await page.getByRole('radio', { name: 'Learned' }).check();
  await expect.poll(async () => (await probe(page)).estimator).toBe('learned');

  await enterVr(page);
  await pass(page, 80);
  await press(page, 'button', 'Record');
  await pass(page, 400);
  await press(page, 'button', 'Stop');
  await endDrivenTime(page);
  const overlay = page.locator('#overlay');
  await expect(overlay).toContainText('Learned ·');
  await expect(overlay).toContainText(/cm from the device’s: elbows \d+\.\d, \d+\.\d/);
  await press(page, 'radio', 'Device');
  await expect(overlay).toContainText('Device ·');
  await expect(page.locator('#about-device')).toContainText('The body that the headset tracks itself');
  const download = page.waitForEvent('download');
  await press(page, 'button', 'Download');
  const { frames, estimators } = evaluated(await (await download).path(), testInfo.outputPath('evaluated.json'));
  expect(frames).toBeGreaterThan(350);
  // The device's body is what inverse kinematics drew; a file rounds it to a tenth of a millimetre.
  expect(estimators.ik?.mpjpeCm.median).toBeLessThan(0.01);
  expect(estimators.learned?.mpjpeCm.mean).toBeGreaterThan(1);

  await press(page, 'button', 'Exit VR');
  await press(page, 'button', 'Replay');
  await page.getByRole('radio', { name: 'Learned' }).check();
  await expect(overlay).toContainText(/pelvis [1-9]\.\d/);
  await keepPicture(page, 'device-body-difference');
});

test('a headset without a body, or not asked, is reported, and the learned body is drawn @full', async ({ page }) => {
  await open(page, 'emulate&quality=low&estimator=device');
  await emulatedHeadset(page);
  await enterVr(page, { stepMs: null });
  await expect(page.locator('#about-device')).toContainText(
    'Learned is used instead: the headset’s body tracking is off.',
  );
  expect((await probe(page)).estimator).toBe('device');
  await press(page, 'button', 'Exit VR');
  await expect(page.locator('#about-device')).toContainText('The body that the headset tracks itself');
  await askSwitch(page).check();
  await enterVr(page, { stepMs: null });
  await expect(page.locator('#about-device')).toContainText('Learned is used instead: the device reports no body.');
});
