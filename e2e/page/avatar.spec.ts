import { readdirSync, readFileSync } from 'node:fs';
import { changed, type GltfJson } from '../../tests/threepoint/avatar/glb';
import { etc1sPicture, ktx2Picture, zstdPicture } from '../../tests/threepoint/avatar/ktx2-picture';
import { expect, joint, keepPicture, open, openWithHeadset, probe, settledJoint, test } from '../page-fixture';

const avatarFile = readdirSync('public/avatars').find((name) => name.endsWith('.vrm'));

test('a VRM from a local file takes the place of ours, with the hands still on the controllers', async ({ page }) => {
  if (!avatarFile) throw new Error('public/avatars holds no .vrm: npm run build:avatar');
  await openWithHeadset(page, 'estimator=ik');
  const hand = await settledJoint(page, 'leftHand');
  await page.getByRole('tab', { name: 'Avatar' }).click();
  await page
    .getByLabel('Open VRM or GLB')
    .and(page.locator('input'))
    .setInputFiles({
      name: 'another-person.vrm',
      mimeType: 'model/gltf-binary',
      buffer: readFileSync(`public/avatars/${avatarFile}`),
    });
  await expect.poll(async () => (await probe(page)).avatar.name).toMatch(/another-person/);
  await expect
    .poll(async () => {
      const now = await joint(page, 'leftHand');
      return 1000 * Math.hypot(now[0] - hand[0], now[1] - hand[1], now[2] - hand[2]);
    })
    .toBeLessThan(1);
  await page.getByRole('button', { name: 'Back to the page’s avatar' }).click();
  await expect.poll(async () => (await probe(page)).avatar.name).not.toMatch(/another-person/);
});

test('a file that is no avatar is refused in a sentence, and ours stays', async ({ page, complaints }) => {
  complaints.allow(/holiday/);
  await openWithHeadset(page);
  const { name } = (await probe(page)).avatar;
  await page.getByRole('tab', { name: 'Avatar' }).click();
  await page
    .getByLabel('Open VRM or GLB')
    .and(page.locator('input'))
    .setInputFiles({ name: 'holiday.vrm', mimeType: 'model/gltf-binary', buffer: Buffer.from('a picture') });
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

/** The mannequin, all of it in a picture packed as KTX2. */
const inKtx2 = (picture: Uint8Array) =>
  changed((json, length) => {
    const { materials } = json as GltfJson & { materials: { name: string; pbrMetallicRoughness: object }[] };
    json.bufferViews.push({ buffer: 0, byteOffset: length, byteLength: picture.length });
    json.images = [{ bufferView: json.bufferViews.length - 1, mimeType: 'image/ktx2' }];
    json.buffers = [{ byteLength: length + picture.length }];
    json.textures = [{ extensions: { KHR_texture_basisu: { source: 0 } } }];
    json.extensionsUsed.push('KHR_texture_basisu');
    json.extensionsRequired = ['KHR_texture_basisu'];
    // Every corner lies in the picture's first one.
    for (const { attributes } of json.meshes.flatMap(({ primitives }) => primitives)) {
      const { count } = json.accessors[attributes.POSITION!]!;
      attributes.TEXCOORD_0 = json.accessors.push({ count, type: 'VEC2', componentType: 5126 }) - 1;
    }
    for (const material of materials) {
      material.name = `Packed ${material.name}`;
      Object.assign(material.pbrMetallicRoughness, { baseColorFactor: [1, 1, 1, 1], baseColorTexture: { index: 0 } });
    }
  }, picture);

/** How many of 320 by 200 pixels of the stage are magenta. */
const magenta = (page: Parameters<typeof probe>[0]) =>
  page.evaluate(
    () =>
      new Promise<number>((resolve) => {
        const stage = document.querySelector<HTMLCanvasElement>('#stage');
        const pixels = Object.assign(document.createElement('canvas'), { width: 320, height: 200 }).getContext('2d');
        if (!stage || !pixels) throw new Error('no picture');
        // After the page's own callback of the frame, while its picture is still there to be read.
        requestAnimationFrame(() => {
          pixels.drawImage(stage, 0, 0, 320, 200);
          const { data } = pixels.getImageData(0, 0, 320, 200);
          let found = 0;
          for (let i = 0; i < data.length; i += 4)
            if (data[i]! > 60 && data[i]! > 2 * data[i + 1]! && data[i + 2]! > 2 * data[i + 1]!) found += 1;
          resolve(found);
        });
      }),
  );

test('pictures packed as KTX2 are unpacked under the page’s policy; one that cannot be is refused in a sentence @full', async ({
  page,
  complaints,
}) => {
  complaints.allow(/broken\.vrm|KTX2|Couldn't load texture/);
  await open(page, 'emulate&actor=off&quality=low');
  expect(await magenta(page)).toBe(0);
  await page.getByRole('tab', { name: 'Avatar' }).click();
  const files = page.getByLabel('Open VRM or GLB').and(page.locator('input'));
  const whole = ktx2Picture([[[255, 0, 255, 255]]]);
  const broken = whole.slice();
  // ETC1S, of which the file has nothing.
  broken[116] = 163;
  const give = (name: string, picture: Uint8Array) =>
    files.setInputFiles({ name, mimeType: 'model/gltf-binary', buffer: Buffer.from(inKtx2(picture)) });
  await give('packed.vrm', whole);
  await expect.poll(async () => (await probe(page)).avatar.name).toMatch(/packed/);
  await expect.poll(() => magenta(page)).toBeGreaterThan(200);
  await keepPicture(page, 'avatar-in-ktx2');
  for (const [name, picture] of [
    ['etc1s', etc1sPicture],
    ['zstandard', zstdPicture],
  ] as const) {
    await page.getByRole('button', { name: 'Back to the page’s avatar' }).click();
    await expect.poll(() => magenta(page)).toBe(0);
    await give(`${name}.vrm`, picture);
    await expect.poll(async () => (await probe(page)).avatar.name).toMatch(name);
    await expect.poll(() => magenta(page)).toBeGreaterThan(200);
  }
  await give('broken.vrm', broken);
  await expect(page.getByRole('alert')).toContainText('broken.vrm');
});
