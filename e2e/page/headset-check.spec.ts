import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import type { Page } from '@playwright/test';
import { readHeadsetReport } from '../../src/page/check/headset-report';
import { driveTime, endDrivenTime, pass } from '../driven-time';
import { emulatedHeadset } from '../emulated-headset';
import { expect, keepPicture, freshTest as test } from '../page-fixture';
import { bundlePolyfill } from '../polyfill-bundle';

const root = fileURLToPath(new URL('../..', import.meta.url));
const rateHz = 60;
/** The white noise of the emulated head and hands: by axis [mm], and of the head by component [°]. */
const noise = { headMm: 0.1, headDegrees: 0.05, handsMm: 0.4 };
/** How long hands are out of view [frames]: the left twice, the right once. */
const lost = { left: [6, 30], right: [12] };

/** Moves the emulated devices in every frame: sway and known noise, and known losses in the step “Lost hands”. */
const wear = (page: Page) =>
  page.evaluate(
    ({ noise, lost, rateHz }) => {
      const device = window.emulatedDevice;
      device.controlMode = 'programmatic';
      let state = 1;
      const uniform = () => {
        state = (Math.imul(state, 1664525) + 1013904223) | 0;
        return ((state >>> 8) + 0.5) / 2 ** 24;
      };
      const normal = (size: number) => size * Math.sqrt(-2 * Math.log(uniform())) * Math.cos(2 * Math.PI * uniform());
      const seen = (side: 'left' | 'right', row: number) => {
        let from = 10;
        for (const frames of lost[side]) {
          if (row >= from && row < from + frames) return false;
          from += frames + 40;
        }
        return true;
      };
      let row = 0;
      let losing = 0;
      const next = () => {
        row += 1;
        const sway = 0.005 * Math.sin((2 * Math.PI * 0.4 * row) / rateHz);
        const at = (mm: number) => normal(mm / 1000) + sway;
        device.position.set(at(noise.headMm), 1.6 + at(noise.headMm), at(noise.headMm));
        const half = (noise.headDegrees * Math.PI) / 360;
        device.quaternion.set(normal(half), normal(half), normal(half), 1);
        const title = document.querySelector('[aria-current=step]')?.textContent;
        losing = title === 'Lost hands' ? losing + 1 : 0;
        for (const [side, x] of [
          ['left', -0.22],
          ['right', 0.22],
        ] as const) {
          const hand = device.controllers[side];
          hand.position.set(x + at(noise.handsMm), 1.1 + at(noise.handsMm), -0.35 + at(noise.handsMm));
          hand.connected = seen(side, losing - 90);
        }
        requestAnimationFrame(next);
      };
      next();
    },
    { noise, lost, rateHz },
  );

/** The steps of which pictures are kept. */
const pictured: ReadonlySet<string> = new Set(['Noise at rest', 'Lost hands', 'Frames: Archery', 'Frames: Ball game']);

/** Runs the check to its end; returns the titles of its steps. */
async function walk(page: Page): Promise<readonly string[]> {
  const titles: string[] = [];
  while (await page.evaluate(() => Boolean(window.emulatedDevice.activeSession))) {
    const title = await page.evaluate(() => document.querySelector('[aria-current=step]')?.textContent ?? '');
    if (title !== '' && titles.at(-1) !== title) {
      titles.push(title);
      if (pictured.has(title)) await keepPicture(page, `headset-check-${titles.length}`);
    }
    await pass(page, 30);
  }
  return titles;
}

test('a headset check measures the emulator’s known noise and losses and writes a valid file @full', async ({
  page,
}, testInfo) => {
  await page.goto('/check?emulate&quality=low&pace=0.25');
  const start = page.getByRole('button', { name: 'Start in the emulated headset' });
  await expect(start).toBeEnabled({ timeout: 60_000 });
  await keepPicture(page, 'headset-check-start');
  await emulatedHeadset(page);
  await page.evaluate(`${await bundlePolyfill()}; bodyPolyfill.installBodyTracking({ estimator: 'ik' }); null`);
  // Time stands still until the devices move.
  await driveTime(page, 1000 / rateHz);
  await page.evaluate(() => window.drivenTime?.hold());
  await start.click();
  await page.waitForFunction(() => Boolean(window.emulatedDevice?.activeSession), undefined, { polling: 100 });
  await wear(page);
  expect(await walk(page)).toEqual([
    'Welcome',
    'Noise at rest',
    'Lost hands',
    'Body tracking',
    'Frames: Mirror',
    'Frames: Archery',
    'Frames: Ball game',
    'Done',
  ]);
  await endDrivenTime(page);

  const card = page.getByRole('region', { name: 'Your card' });
  await expect(card).toContainText('Nothing has been sent.');
  await expect(card).toBeFocused();
  await expect(card).not.toContainText(/too few|Not measured/);
  await page.setViewportSize({ width: 960, height: 2200 });
  await keepPicture(page, 'headset-check-card');
  await page.setViewportSize({ width: 390, height: 1200 });
  await keepPicture(page, 'headset-check-card-narrow');
  await expect(page.getByRole('button', { name: 'Measure again' })).toBeEnabled();
  const download = page.waitForEvent('download');
  await card.getByRole('button', { name: 'Download the file' }).click();
  const file = testInfo.outputPath('headset-check.json');
  await (await download).saveAs(file);

  const report = readHeadsetReport(readFileSync(file, 'utf8'));
  expect(report.device).toMatchObject({ emulated: true, profiles: ['meta-quest-touch-plus'] });
  expect(report.device.userAgent).not.toContain('Quest');
  expect(report.session).toMatchObject({ complete: true, rateHz, rateReported: false, ratesHz: [72, 80, 90, 120] });
  expect(report.unmeasured).toEqual([]);
  expect(report.features.modes).toEqual(['inline', 'immersive-vr', 'immersive-ar']);
  expect(report.features.granted).toContain('local-floor');
  const [head, left, right] = report.noise;
  const off = (measured: number, known: number) => Math.abs(measured / known - 1);
  expect(off(head!.positionMm.frame, noise.headMm)).toBeLessThan(0.3);
  expect(off(head!.rotationDegrees.frame, noise.headDegrees)).toBeLessThan(0.3);
  for (const hand of [left!, right!]) {
    expect(hand).toMatchObject({ source: 'controller', repeated: 0 });
    expect(off(hand.positionMm.frame, noise.handsMm)).toBeLessThan(0.3);
    expect(hand.rotationDegrees.frame).toBeLessThan(0.001);
    // A sway of 5 mm, which is not counted.
    expect(hand.positionMm.sway).toBeGreaterThan(2);
  }
  for (const { hand, lengthsMs, openEnd } of report.losses) {
    expect(lengthsMs).toHaveLength(lost[hand].length);
    // The emulator's time stamps vary within a step, and the page's clock counts a step below 1 ms as a whole one.
    lengthsMs.forEach((ms, index) => {
      expect(Math.abs((ms * rateHz) / 1000 - lost[hand][index]!)).toBeLessThan(2.01);
    });
    expect(openEnd).toBe(false);
  }
  expect(report.frameTimes).toHaveLength(3 * 5);
  for (const { estimator, drawnBy, missed, work } of report.frameTimes) {
    expect(drawnBy).toBe(estimator);
    expect(work.frames).toBeGreaterThan(20);
    // The time stamps again: a steady frame may seem late.
    expect(missed).toBeLessThan(work.frames);
    expect(work.p50Ms).toBeGreaterThan(0);
  }
  // The emulator predicts the display at the frame's own time: before the work of a slow machine, which is not known.
  expect(report.latency.displayAhead?.p50Ms ?? 0).toBeLessThan(1);
  expect(report.latency.callbackDelay!.frames).toBeGreaterThan(1000);
  expect(report.bodyTracking.frames).toBeGreaterThan(100);
  expect(report.bodyTracking.joints!.leftLowerArm).toBeLessThan(15);

  const program = ['--import', 'tsx', 'bench/evaluate/check-headset.ts', file];
  const printed = execFileSync(process.execPath, program, { cwd: root, encoding: 'utf8' });
  expect(printed).toContain(`${file}: valid`);
  expect(printed).toContain('Noise at rest');
});

for (const stop of ['Escape', 'Stop'] as const) {
  test(`a check in the emulated headset is stopped by ${stop} and shows what it measured @full`, async ({ page }) => {
    await page.goto('/check?quality=low');
    await expect(page.getByText('It has no sensors')).toBeVisible({ timeout: 60_000 });
    await page.getByRole('button', { name: 'Start in the emulated headset' }).click();
    const bar = page.getByRole('region', { name: 'Emulated headset' });
    await expect(bar).toContainText('Stand upright, look ahead');
    await expect(bar).toContainText('Drag the arrows at a hand');
    if (stop === 'Stop') await bar.getByRole('button', { name: stop }).click();
    else await page.keyboard.press(stop);
    await expect(page.getByRole('region', { name: 'Your card (incomplete)' })).toBeFocused();
    await expect(bar).toBeHidden();
    await expect(page.getByRole('button', { name: 'Measure again' })).toBeEnabled();
  });
}
