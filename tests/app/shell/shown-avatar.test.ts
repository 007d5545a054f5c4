import { readFileSync } from 'node:fs';
import { type Material, type Mesh, MeshStandardMaterial, Scene } from 'three';
import { expect, test } from 'vitest';
import { ShownAvatar } from '../../../src/app/shell/shown-avatar';
import { palettes, skinColors } from '../../../src/avatar/palettes';
import { defaultCalibration } from '../../../src/core/body/calibration';

const file = readFileSync(new URL('../../../public/avatars/woman.vrm', import.meta.url));
const bytes = () =>
  Promise.resolve(file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength) as ArrayBuffer);
const clothes = (palette: string) => palettes.find(({ name }) => name === palette)?.color;

test('a body of ours keeps the colours of its seat when another takes its place, and its tone of skin', async () => {
  const scene = new Scene();
  const avatar = new ShownAvatar({
    scene,
    settings: { palette: 'porcelain', upperBodyOnly: false, ownBody: 'woman', skinTone: 'dark' },
    body: { calibration: defaultCalibration },
    notices: { show: (_, text) => expect(text).toBeNull() },
    knownBones: { of: () => undefined, keep: () => undefined },
    prepare: () => Promise.resolve(),
    onChange: () => undefined,
  });
  const colourOf = (material: string): string => {
    const found: Material[] = [];
    scene.traverse((node) => found.push(...[(node as Mesh).material ?? []].flat()));
    const named = found.find(({ name }) => name === material);
    return named instanceof MeshStandardMaterial ? `#${named.color.getHexString()}` : 'none';
  };
  await avatar.openOwn(bytes());
  expect([colourOf('Top'), colourOf('Skin')]).toEqual([clothes('porcelain'), skinColors.dark]);
  avatar.wear('ember');
  await avatar.openOwn(bytes());
  expect([colourOf('Top'), colourOf('Skin')]).toEqual([clothes('ember'), skinColors.dark]);
  expect(avatar.worn).toBe('woman-dark');
  avatar.wear(null);
  expect(colourOf('Top')).toBe(clothes('porcelain'));
});
