import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { expect, keepPicture, probe, freshTest as test } from '../page-fixture';

/** iwer as a browser's own WebXR: the page takes it for a real headset, with rates of its own. */
const headset = readFileSync(createRequire(import.meta.url).resolve('iwer/build/iwer.min.js'), 'utf8');

declare const IWER: { XRDevice: new (config: object, options: object) => object; metaQuest3: object };

test('a headset that draws late is asked for a lower rate, and View shows it @full', async ({ page }) => {
  test.setTimeout(180_000);
  await page.addInitScript(headset);
  await page.addInitScript(() => {
    const device = new IWER.XRDevice(IWER.metaQuest3, { stereoEnabled: false }) as {
      installRuntime(options: object): void;
    };
    device.installRuntime({ forceInstall: true });
  });
  await page.goto('/?quality=low&estimator=ik&panel=off');
  await page.waitForFunction(() => window.threepoint?.probe().ready === true, undefined, { timeout: 60_000 });
  await page.getByRole('button', { name: 'Enter VR', exact: true }).click();
  await expect.poll(async () => (await probe(page)).activity).toBe('vr');
  // The rates of the emulated headset are names alone: this window draws at 60 Hz or less, and is late at 90 Hz.
  await expect.poll(async () => (await probe(page)).frame.rateHz, { timeout: 60_000 }).toBeLessThan(90);
  const {
    frame: { rateHz },
    drawing: { savings },
  } = await probe(page);
  // Before the rate is lowered, the picture gives up what is missed least.
  expect(savings).toEqual({ foveation: 1, mirrorRateHz: 36 });
  await page.getByRole('button', { name: 'Controls' }).click();
  await page.getByRole('tab', { name: 'View' }).click();
  await expect(page.getByRole('tabpanel')).toContainText(
    /Frame rate: (72|80) Hz, the highest that the page holds of 72, 80, 90, 120 Hz\./,
  );
  expect([72, 80]).toContain(rateHz);
  await keepPicture(page, 'frame-rate-view');
});
