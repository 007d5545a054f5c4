import { changed, type GltfJson } from '../../tests/threepoint/avatar/glb';
import { expect, joint, keepPicture, load, open, probe, test } from '../page-fixture';

test.use({ viewport: { width: 960, height: 760 } });

type Page = Parameters<typeof probe>[0];

/** The mannequin as no VRM, with a hand that is called a knee. */
const bones: Record<string, string> = {};
const robot = Buffer.from(
  changed((json: GltfJson) => {
    const { humanBones } = json.extensions.VRMC_vrm?.humanoid ?? { humanBones: {} };
    for (const bone of Object.keys(humanBones)) bones[bone] = bone === 'leftHand' ? 'part left knee' : `part ${bone}`;
    for (const [index, node] of json.nodes.entries()) node.name = `part ${index}`;
    for (const [bone, { node }] of Object.entries(humanBones)) json.nodes[node]!.name = bones[bone]!;
    for (const extension of ['extensions', 'extensionsUsed']) delete json[extension];
  }),
);

const openRobot = async (page: Page): Promise<void> => {
  await page.getByRole('tab', { name: 'Avatar' }).click();
  const file = { name: 'robot.glb', mimeType: 'model/gltf-binary', buffer: robot };
  await page.getByLabel('Open VRM, GLB or FBX').and(page.locator('input')).setInputFiles(file);
};

test('a file whose bones’ names tell nothing is worn once they are told, and again without asking @full', async ({
  page,
  complaints,
}) => {
  complaints.allow(/robot\.glb/);
  await open(page, 'quality=low&estimator=ik&panel=on');
  await joint(page, 'hips');
  await openRobot(page);
  const form = page.locator('.bones');
  await expect(form.getByRole('heading', { name: 'Bones of this file' })).toBeVisible();
  await form.getByRole('button', { name: 'Use these bones' }).click();
  await expect(form.getByRole('alert')).toContainText('Still missing: left hand');
  await keepPicture(page, 'bones-asked');

  await form
    .locator('label', { hasText: /^Hips/ })
    .locator('select')
    .selectOption(bones.hips ?? '');
  await form.getByText('As text, including fingers and toes').click();
  const text = form.getByLabel('Bone map as text');
  await text.fill('{"spine": "backbone"}');
  await form.getByRole('button', { name: 'Use these bones' }).click();
  await expect(form.getByRole('alert')).toContainText('The text maps spine to “backbone”, which is not in this file');
  const { hips: _, ...others } = bones;
  await text.fill(JSON.stringify(others));
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
