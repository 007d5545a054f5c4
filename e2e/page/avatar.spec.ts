import { readdirSync, readFileSync } from 'node:fs';
import {
  expect,
  expectJointAt,
  keepPicture,
  load,
  open,
  openAvatarFile,
  openWithHeadset,
  probe,
  settledJoint,
  test,
} from '../page-fixture';

const avatarFile = readdirSync('public/avatars').find((name) => name.endsWith('.vrm'));

test('a VRM from a local file replaces our body, also on the next visit', async ({ page }) => {
  if (!avatarFile) throw new Error('public/avatars holds no .vrm: npx tsx tools/avatars/build/main.ts');
  await openWithHeadset(page, 'estimator=ik');
  const hand = await settledJoint(page, 'leftHand');
  await openAvatarFile(page, 'another-person.vrm', readFileSync(`public/avatars/${avatarFile}`));
  await expect.poll(async () => (await probe(page)).avatar.name).toMatch(/another-person/);
  await expectJointAt(page, 'leftHand', hand);
  await expect(page.getByText('another-person.vrm is your avatar now.')).toBeVisible();

  const next = 'emulate&actor=off&quality=low&estimator=ik';
  await load(page, next);
  await expect.poll(async () => (await probe(page)).avatar.name).toMatch(/another-person/);
  await page.getByRole('tab', { name: 'Avatar' }).click();
  await page.getByRole('button', { name: 'Back to the page’s avatar' }).click();
  await expect.poll(async () => (await probe(page)).avatar.name).not.toMatch(/another-person/);
  await load(page, next);
  await expect(page.getByRole('button', { name: 'Back to the page’s avatar', includeHidden: true })).toHaveCount(0);
});

test('a file that is no avatar is refused in a sentence, and ours stays', async ({ page, complaints }) => {
  complaints.allow(/holiday/);
  await openWithHeadset(page);
  const { name } = (await probe(page)).avatar;
  await openAvatarFile(page, 'holiday.vrm', Buffer.from('a picture'));
  await expect(page.getByRole('alert')).toContainText('holiday.vrm');
  expect((await probe(page)).avatar.name).toBe(name);
});

test('a switch shows the upper body alone @full', async ({ page }) => {
  await open(page, 'emulate&actor=off&quality=low');
  await keepPicture(page, 'full-body');
  await page.getByRole('tab', { name: 'Avatar' }).click();
  const upperBody = page.getByRole('switch', { name: 'Upper body only' });
  const stage = page.locator('#stage');
  const before = await stage.screenshot();
  await upperBody.check();
  await expect(upperBody).toBeChecked();
  await expect.poll(async () => (await stage.screenshot()).equals(before)).toBe(false);
  await keepPicture(page, 'upper-body-only');
});
