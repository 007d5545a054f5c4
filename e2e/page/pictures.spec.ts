import type { Placement } from '../emulated-headset';
import { expectHandsOnControllers } from '../hands-on-controllers';
import { enterVr, expect, joint, keepPicture, openWithHeadset, probe, test } from '../page-fixture';

/** One hand raised to the chest, the other beside the hip; so many metres from where the room begins. */
const standing = (ahead: number): Placement => ({
  head: { position: [0, 1.6, -ahead], orientation: [0, 0, 0, 1] },
  left: { position: [-0.3, 1.25, -0.32 - ahead], orientation: [0, -0.1305262, 0, 0.9914449] },
  right: { position: [0.32, 1.0, -0.2 - ahead], orientation: [-0.1305262, 0, 0, 0.9914449] },
});

/** In the order of their keys. */
const estimators = ['learned', 'ik', 'paper', 'hands-only'] as const;

test('pictures from behind and from the front, with each estimator @nightly', async ({ page }) => {
  const headset = await openWithHeadset(page, 'panel=off&quality=high');
  await headset.place(standing(0));
  for (const view of ['front', 'third-person'] as const) {
    await expect.poll(async () => (await probe(page)).view).toBe(view);
    for (const [index, estimator] of estimators.entries()) {
      await page.keyboard.press(String(index + 1));
      await expect.poll(async () => (await probe(page)).estimator).toBe(estimator);
      await expectHandsOnControllers(page, headset);
      await keepPicture(page, `${view}-${estimator}`);
    }
    await page.keyboard.press('v');
  }
});

for (const estimator of estimators) {
  const project = estimator === 'learned' ? '@full' : '@nightly';
  test(`${estimator}: a picture of the mirror in VR ${project}`, async ({ page }) => {
    const headset = await openWithHeadset(page, `estimator=${estimator}&panel=off&quality=high`);
    await enterVr(page);
    // Close to the mirror, which hangs 1.8 m away.
    await headset.place(standing(0.9));
    await expectHandsOnControllers(page, headset);
    expect((await probe(page)).estimator).toBe(estimator);
    await keepPicture(page, `mirror-${estimator}`);
    // No one sees the own head from the inside: it is where the eyes are, and not in the picture.
    expect((await joint(page, 'head'))[1]).toBeGreaterThan(1.4);
  });
}
