import { changed, type GltfJson } from '../../tests/threepoint/avatar/glb';
import { expect, joint, keepPicture, load, open, openAvatarFile, probe, test } from '../page-fixture';

test.use({ viewport: { width: 960, height: 760 } });

type Page = Parameters<typeof probe>[0];

/** Returns the mannequin as no VRM, with a left hand of this name. */
const robot = (leftHand: string): Buffer =>
  Buffer.from(
    changed((json: GltfJson) => {
      const { humanBones } = json.extensions.VRMC_vrm?.humanoid ?? { humanBones: {} };
      for (const [index, node] of json.nodes.entries()) node.name = `part ${index}`;
      for (const [bone, { node }] of Object.entries(humanBones)) json.nodes[node]!.name = `part ${bone}`;
      json.nodes[humanBones.leftHand!.node]!.name = leftHand;
      for (const extension of ['extensions', 'extensionsUsed']) delete json[extension];
    }),
  );

const openRobot = (page: Page, leftHand = 'part left knee'): Promise<void> =>
  openAvatarFile(page, 'robot.glb', robot(leftHand));

/** Taps a bone on the picture until it is chosen: taps among bones that are close together enlarge them. */
async function tapBone(page: Page, name: string): Promise<void> {
  const bone = page.getByRole('option', { name: `${name}:` });
  const whole = page.getByRole('button', { name: 'Whole body' });
  if (await whole.isVisible()) await whole.click();
  for (let taps = 0; taps < 6 && (await bone.getAttribute('aria-selected')) !== 'true'; taps++) {
    await bone.locator('circle').scrollIntoViewIfNeeded();
    const box = await bone.locator('circle').boundingBox();
    if (!box) throw new Error(`${name} is not drawn`);
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  }
  await expect(bone).toHaveAttribute('aria-selected', 'true');
}

test('a file whose bones’ names mean nothing is worn once mapped, and again without asking @full', async ({
  page,
  complaints,
}) => {
  complaints.allow(/robot\.glb/);
  await open(page, 'quality=low&estimator=ik&panel=on');
  await joint(page, 'hips');
  await openRobot(page);
  const form = page.locator('.bones');
  const boneOf = (name: string) => form.getByRole('option', { name: `${name}:` });
  await expect(form.getByRole('heading', { name: 'Bones of this file' })).toBeVisible();
  await form.getByRole('button', { name: 'Use these bones' }).click();
  await expect(form.getByRole('alert')).toContainText('Still missing: left hand');

  // A part of the list is found on the picture; a missing one is given the bone that is chosen next.
  await form.getByRole('button', { name: 'Hips: part hips' }).click();
  await expect(boneOf('part hips')).toHaveAttribute('aria-selected', 'true');
  await form.getByRole('button', { name: 'Left hand: missing' }).click();
  await expect(form.getByRole('status')).toContainText('Choose the bone of the left hand');
  await keepPicture(page, 'bones-asked');
  await tapBone(page, 'part left knee');
  await expect(form.getByRole('button', { name: 'Left hand: part left knee' })).toHaveAttribute('aria-pressed', 'true');

  // A bone of the picture becomes a part by its list, and another one by the keyboard.
  await tapBone(page, 'part leftIndexProximal');
  const part = form.getByLabel('part leftIndexProximal is');
  await part.selectOption('Left index finger 1');
  await keepPicture(page, 'bones-fingers');
  await boneOf('part leftIndexProximal').focus();
  await page.keyboard.press('ArrowDown');
  await expect(boneOf('part leftIndexIntermediate')).toBeFocused();
  await expect(form.getByLabel('part leftIndexIntermediate is')).toBeVisible();
  await form.getByRole('button', { name: 'Whole body' }).click();
  await page.setViewportSize({ width: 390, height: 844 });
  await form.scrollIntoViewIfNeeded();
  await keepPicture(page, 'bones-phone');
  await form.getByRole('button', { name: 'Use these bones' }).click();
  await expect.poll(async () => (await probe(page)).avatar.name).toBe('robot.glb');
  await expect(form).toBeHidden();
  // Its joints are known from its first picture on.
  await expect.poll(async () => Object.keys((await probe(page)).avatar.joints)).toContain('leftHand');

  await load(page, 'quality=low&estimator=ik&panel=on');
  await openRobot(page);
  await expect.poll(async () => (await probe(page)).avatar.name).toBe('robot.glb');
  await keepPicture(page, 'bones-remembered');
  await page.getByRole('button', { name: 'Back to the page’s avatar' }).click();
  await page.evaluate(() => localStorage.clear());
});

test('a worn file with a wrong bone is corrected, stays corrected, and goes back @full', async ({ page }) => {
  await open(page, 'quality=low&estimator=ik&panel=on');
  await joint(page, 'hips');
  const form = page.getByRole('region', { name: 'Bones of this file' });
  const correct = page.getByRole('button', { name: 'Correct the bones…' });
  const isWorn = expect.poll(async () => (await probe(page)).avatar.name);
  const jointsOf = expect.poll(async () => Object.keys((await probe(page)).avatar.joints));
  await page.getByRole('tab', { name: 'Avatar' }).click();
  await expect(correct).toBeHidden();
  await openRobot(page, 'part leftHand');
  await isWorn.toBe('robot.glb');
  await jointsOf.toContain('neck');
  await keepPicture(page, 'bones-worn');

  // Another idea is given up by Cancel or Esc, and the focus returns to where it was.
  await correct.click();
  await expect(form).toBeFocused();
  await keepPicture(page, 'bones-correcting');
  await form.getByRole('button', { name: 'Neck: part neck' }).click();
  await form.getByLabel('part neck is').selectOption('no part of the body');
  await form.getByRole('button', { name: 'Cancel' }).click();
  await expect(correct).toBeFocused();

  await correct.click();
  await expect(form).toBeFocused();
  await page.keyboard.press('Escape');
  await expect(form).toHaveCount(0);
  await expect(correct).toBeFocused();

  await correct.click();
  await form.getByRole('button', { name: 'Neck: part neck' }).click();
  await form.getByLabel('part neck is').selectOption('no part of the body');
  await expect(form.getByRole('button', { name: 'Forget my map' })).toHaveCount(0);
  await form.getByRole('button', { name: 'Use these bones' }).click();
  await expect(page.getByText('robot.glb has the new bones now.')).toBeVisible();
  await expect(form).toHaveCount(0);
  await jointsOf.not.toContain('neck');

  await load(page, 'quality=low&estimator=ik&panel=on');
  await page.setViewportSize({ width: 390, height: 844 });
  await openRobot(page, 'part leftHand');
  await isWorn.toBe('robot.glb');
  await jointsOf.not.toContain('neck');
  await keepPicture(page, 'bones-worn-phone');
  await correct.click();
  await expect(form.getByRole('button', { name: 'Neck: not mapped' })).toBeVisible();
  await keepPicture(page, 'bones-correcting-phone');
  await form.getByRole('button', { name: 'Forget my map' }).click();
  await jointsOf.toContain('neck');
  await page.evaluate(() => localStorage.clear());
});
