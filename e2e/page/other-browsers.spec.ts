import { buttonPath, inBrowser, isInstalled, type OtherBrowser, otherBrowsers } from '../other-browser';
import { expect, freshTest as test } from '../page-fixture';

/** What the page's probe says, as far as it is JSON. */
const probeIn = async ({ evaluate }: OtherBrowser) =>
  JSON.parse(await evaluate(() => JSON.stringify(window.threepoint?.probe() ?? {})));

const patience = { timeout: 120_000 };

for (const name of otherBrowsers) {
  test.describe(name, () => {
    // biome-ignore lint/suspicious/noSkippedTests: reason: a program that the suite's name mentions is missing
    test.skip(!isInstalled(name), `${name} is not installed`);
    test.beforeEach(() => test.setTimeout(600_000));

    test(`the page, both games and emulated VR run in ${name} with the learned network @nightly`, ({ origin }) =>
      inBrowser(name, async (browser) => {
        const state = () => probeIn(browser);
        const score = async () => (await state()).game?.score ?? 0;
        await browser.open(`${origin}/?quality=low&seed=7&seconds=60`);
        await expect.poll(async () => (await state()).estimator, patience).toBe('learned');
        for (const game of ['Archery', 'Ball game']) {
          await browser.click(buttonPath(game));
          await expect.poll(score, patience).toBeGreaterThan(0);
        }
        await browser.click(buttonPath('Mirror'));
        await browser.click(buttonPath('Enter VR'));
        await expect.poll(async () => (await state()).activity, patience).toBe('vr');
        const { estimator, avatar, notices } = await state();
        expect(estimator).toBe('learned');
        expect(Object.values(avatar.joints).flat().every(Number.isFinite)).toBe(true);
        expect(notices).toEqual([]);
      }));
  });
}
