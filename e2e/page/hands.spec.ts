import { frames, type Placement } from '../emulated-headset';
import { expectHandsOnControllers, wristName } from '../hands-on-controllers';
import { distance, enterVr, expect, joint, openWithHeadset, probe, test } from '../page-fixture';

/** Placements within reach of a standing person, turned and not; the orientation is that of the target ray. */
const placements: readonly Placement[] = [
  {
    head: { position: [0, 1.6, 0], orientation: [0, 0, 0, 1] },
    left: { position: [-0.25, 1.1, -0.35], orientation: [0, 0, 0, 1] },
    right: { position: [0.25, 1.1, -0.35], orientation: [0, 0, 0, 1] },
  },
  {
    // The body turned a quarter to the left, one hand high, one at the hip.
    head: { position: [0.5, 1.55, 0.4], orientation: [0, Math.SQRT1_2, 0, Math.SQRT1_2] },
    left: { position: [0.15, 1.5, 0.65], orientation: [0.3535534, 0.6123724, -0.3535534, 0.6123724] },
    right: { position: [0.4, 0.95, 0.15], orientation: [-0.2705981, 0.6532815, 0.2705981, 0.6532815] },
  },
  {
    // Turned round, hands crossed in front of the chest.
    head: { position: [-0.3, 1.62, -0.2], orientation: [0, 1, 0, 0] },
    left: { position: [-0.4, 1.25, 0.1], orientation: [0, 0.9659258, 0.258819, 0] },
    right: { position: [-0.2, 1.2, 0.12], orientation: [0.258819, 0.9659258, 0, 0] },
  },
];

for (const estimator of ['hands-only', 'ik', 'paper', 'learned'] as const) {
  // The one that every visitor starts with by day (IK's wrists: the next test), the others by night.
  const night = estimator === 'learned' ? '' : ' @nightly';
  test(`${estimator}: the hands land on the controllers within 1 mm${night}`, async ({ page }) => {
    const headset = await openWithHeadset(page, `estimator=${estimator}`);
    await enterVr(page);
    for (const placement of placements) {
      await headset.place(placement);
      await expectHandsOnControllers(page, headset);
    }
    expect((await probe(page)).estimator).toBe(estimator);
  });
}

test('hands instead of controllers: the wrists are those of the tracked hands, and back again', async ({ page }) => {
  const headset = await openWithHeadset(page, 'estimator=ik');
  await enterVr(page);
  await headset.place(placements[0] as Placement);
  await expectHandsOnControllers(page, headset);
  for (let round = 0; round < 3; round++) {
    await headset.useInput('hand');
    for (const side of ['left', 'right'] as const) {
      const { position } = await headset.wristJoint(side);
      await expect
        .poll(async () => 1000 * distance(await joint(page, wristName[side]), position), { message: `${side} wrist` })
        .toBeLessThan(1);
    }
    await headset.useInput('controller');
    await expectHandsOnControllers(page, headset);
  }
});

test('both hands lost: the body stays whole, the head still moves', async ({ page }) => {
  const headset = await openWithHeadset(page, 'estimator=learned');
  await enterVr(page);
  await headset.place(placements[0] as Placement);
  await frames(page, 10);
  await headset.setConnected('left', false);
  await headset.setConnected('right', false);
  await expect.poll(async () => (await probe(page)).tracking?.rightHand).toBeNull();
  await headset.place({ head: { position: [0.3, 1.6, 0] } });
  await expect.poll(async () => Math.abs((await joint(page, 'head'))[0] - 0.3)).toBeLessThan(0.03);
  for (const [name, position] of Object.entries((await probe(page)).avatar.joints)) {
    expect(position.every(Number.isFinite), `${name} is a place`).toBe(true);
    expect(distance(position, [0.3, 1, 0]), `${name} is near the body`).toBeLessThan(1.3);
  }
});

test('recentring moves the room, not the hands off the controllers @full', async ({ page }) => {
  const headset = await openWithHeadset(page, 'estimator=learned');
  await enterVr(page);
  await headset.place(placements[1] as Placement);
  await expectHandsOnControllers(page, headset);
  await headset.recentre();
  await expect
    .poll(async () => Math.hypot(...(await joint(page, 'head')).filter((_, axis) => axis !== 1)))
    .toBeLessThan(0.2);
  await expectHandsOnControllers(page, headset);
});
