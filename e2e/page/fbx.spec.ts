import { deflateSync } from 'node:zlib';
import type { Page } from '@playwright/test';
import { type BoneTurns, builtFbx } from '../../tests/threepoint/avatar/built-fbx';
import { fbxBinary, fbxText } from '../../tests/threepoint/avatar/fbx-file';
import { mixamo } from '../../tests/threepoint/avatar/rig-namings';
import { card } from '../mocap-card';
import { expect, joint, openWithHeadset, probe, settledJoint, test } from '../page-fixture';

const nameOf = mixamo('mixamorig:');
/** Two seconds of a right arm that waves. */
const wave: BoneTurns = {
  rightUpperArm: Array.from({ length: 60 }, (_, frame) => [0, 0, 40 * Math.sin(frame / 9)] as const),
  leftUpperArm: Array.from({ length: 60 }, (_, frame) => [0, 0, -60 - 5 * Math.sin(frame / 20)] as const),
};

async function openAvatar(page: Page, name: string, bytes: ArrayBuffer): Promise<void> {
  await page.getByRole('tab', { name: 'Avatar' }).click();
  await page
    .getByLabel('Open VRM, GLB or FBX')
    .and(page.locator('input'))
    .setInputFiles({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(bytes) });
}

test('an FBX character is worn, with the hands on the controllers', async ({ page }) => {
  await openWithHeadset(page, 'estimator=ik');
  const hand = await settledJoint(page, 'leftHand');
  const written = fbxBinary(builtFbx({ nameOf, turns: wave, studio: true }), deflateSync);
  await openAvatar(page, 'soldier.fbx', written);
  await expect.poll(async () => (await probe(page)).avatar.name).toBe('soldier.fbx');
  await expect
    .poll(async () => {
      const now = await joint(page, 'leftHand');
      return 1000 * Math.hypot(now[0] - hand[0], now[1] - hand[1], now[2] - hand[2]);
    })
    .toBeLessThan(1);
});

test('an FBX file of motion without a body is opened as motion capture', async ({ page }) => {
  await openWithHeadset(page, 'estimator=ik');
  await openAvatar(page, 'wave.fbx', fbxText(builtFbx({ nameOf, turns: wave, bare: true })));
  await expect(card(page).getByRole('heading', { name: 'wave' })).toBeVisible();
  expect((await probe(page)).recorder.mode).toBe('replaying');
});
