import { deflateSync } from 'node:zlib';
import { type BoneTurns, builtFbx } from '../../tests/threepoint/avatar/built-fbx';
import { fbxBinary, fbxText } from '../../tests/threepoint/avatar/fbx-file';
import { mixamo } from '../../tests/threepoint/avatar/rig-namings';
import { card } from '../mocap-card';
import { expect, expectJointAt, openAvatarFile, openWithHeadset, probe, settledJoint, test } from '../page-fixture';

const nameOf = mixamo('mixamorig:');
/** Two seconds of a right arm that waves. */
const wave: BoneTurns = {
  rightUpperArm: Array.from({ length: 60 }, (_, frame) => [0, 0, 40 * Math.sin(frame / 9)] as const),
  leftUpperArm: Array.from({ length: 60 }, (_, frame) => [0, 0, -60 - 5 * Math.sin(frame / 20)] as const),
};

test('an FBX character is worn, with the hands on the controllers', async ({ page }) => {
  await openWithHeadset(page, 'estimator=ik');
  const hand = await settledJoint(page, 'leftHand');
  const written = fbxBinary(builtFbx({ nameOf, turns: wave, studio: true }), deflateSync);
  await openAvatarFile(page, 'soldier.fbx', written);
  await expect.poll(async () => (await probe(page)).avatar.name).toBe('soldier.fbx');
  await expectJointAt(page, 'leftHand', hand);
});

test('an FBX file of motion without a body is opened as motion capture @full', async ({ page }) => {
  await openWithHeadset(page, 'estimator=ik');
  await openAvatarFile(page, 'wave.fbx', fbxText(builtFbx({ nameOf, turns: wave, bare: true })));
  await expect(card(page).getByRole('heading', { name: 'wave' })).toBeVisible();
  expect((await probe(page)).recorder.mode).toBe('replaying');
});
