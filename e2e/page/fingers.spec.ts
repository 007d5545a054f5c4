import type { EmulatedHeadset } from '../emulated-headset';
import { distance, enterVr, expect, openWithHeadset, probe, settledJoint, test } from '../page-fixture';

type Page = Parameters<typeof probe>[0];
type Finger = 'thumb' | 'index' | 'middle' | 'ring' | 'little';

const before = {
  head: { position: [0, 1.6, 0], orientation: [0, 0, 0, 1] },
  left: { position: [-0.25, 1.2, -0.35], orientation: [0, 0, 0, 1] },
  right: { position: [0.25, 1.2, -0.35], orientation: [0, 0, 0, 1] },
} as const;

async function worn(page: Page): Promise<EmulatedHeadset> {
  const headset = await openWithHeadset(page, 'estimator=ik');
  await enterVr(page);
  await headset.place(before);
  // Arms come to hands that are seen for the first time by a way of their own.
  for (const hand of ['leftHand', 'rightHand']) await settledJoint(page, hand);
  return headset;
}

/** How far a finger reaches from its wrist [cm]: wherever the hand is just going. */
async function reach(page: Page, side: 'left' | 'right', finger: Finger): Promise<number> {
  const { joints, fingertips } = (await probe(page)).avatar;
  const [wrist, end] = [joints[`${side}Hand`], fingertips[side][finger]];
  if (!wrist || !end) throw new Error(`the avatar has no ${side} ${finger}`);
  return 100 * distance(end, wrist);
}

test('a controller’s trigger bends the index finger of its hand, and no other finger', async ({ page }) => {
  const headset = await worn(page);
  const open = {
    index: await reach(page, 'right', 'index'),
    middle: await reach(page, 'right', 'middle'),
    left: await reach(page, 'left', 'index'),
  };
  await headset.pull('right', 1);
  const bent = async () => open.index - (await reach(page, 'right', 'index'));
  await expect.poll(bent, { message: 'right index [cm]' }).toBeGreaterThan(1);
  expect(Math.abs((await reach(page, 'right', 'middle')) - open.middle)).toBeLessThan(0.1);
  expect(Math.abs((await reach(page, 'left', 'index')) - open.left)).toBeLessThan(0.1);
  await headset.pull('right', 0);
  await expect.poll(async () => Math.abs(await bent()), { message: 'right index let go [cm]' }).toBeLessThan(0.1);
});
