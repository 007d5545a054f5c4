import { readFileSync } from 'node:fs';
import { type BufferAttribute, MeshStandardMaterial, ShaderLib, type SkinnedMesh } from 'three';
import { expect, test } from 'vitest';
import { createAvatar } from '../../../src/threepoint/avatar/avatar';
import { parseAvatar } from '../../../src/threepoint/avatar/load-avatar';
import { weaveCloth } from '../../../src/threepoint/avatar/rig/cloth-weave';
import { FlatPartsMaterial } from '../../../src/threepoint/avatar/rig/flat-parts';
import { skinnedMeshesOf } from '../../../src/threepoint/avatar/scene-meshes';

const read = (name: string) => parseAvatar(new Uint8Array(readFileSync(`public/avatars/${name}.vrm`)).buffer, name);

/** Returns the colour that is drawn at each vertex of a mesh, by the vertex's place at rest. */
function colorsOf(mesh: SkinnedMesh): Map<string, string> {
  const { position, uv, color } = mesh.geometry.attributes as Record<string, BufferAttribute>;
  const colors = new Map<string, string>();
  for (let vertex = 0; vertex < position!.count; vertex++) {
    const material = mesh.material as MeshStandardMaterial;
    const { parts } = material as FlatPartsMaterial;
    const part = parts ? parts[Math.floor(uv!.getX(vertex) * parts.length)]! : material;
    const tint = color ? [color.getX(vertex), color.getY(vertex), color.getZ(vertex)] : [1, 1, 1];
    const place = [position!.getX(vertex), position!.getY(vertex), position!.getZ(vertex)].join();
    colors.set(
      `${part.name} ${place}`,
      part.color
        .toArray()
        .map((value, i) => (value * tint[i]!).toFixed(6))
        .join(),
    );
  }
  return colors;
}

const all = (meshes: readonly SkinnedMesh[]) => new Map(meshes.flatMap((mesh) => [...colorsOf(mesh)]));

test.each([
  ['mannequin', 2],
  ['man', 3],
] as const)('the %s is drawn by %i meshes, every vertex in the colour of its material', async (name, drawn) => {
  const before = (await read(name)).vrm.scene;
  const file = all(skinnedMeshesOf(before));
  const { object } = createAvatar(await read(name));
  const meshes = skinnedMeshesOf(object);
  expect(meshes).toHaveLength(drawn);
  expect(meshes.some(({ material }) => material instanceof FlatPartsMaterial)).toBe(true);
  expect(all(meshes)).toEqual(file);
});

test('the weave marks the clothes of a person, and nothing of the mannequin', async () => {
  const woven = async (name: string) => {
    const { object } = createAvatar(await read(name));
    const materials = skinnedMeshesOf(object).flatMap(({ material }) =>
      material instanceof FlatPartsMaterial ? [material] : [],
    );
    return materials.flatMap(({ parts, roughnessMap }) => {
      const texels = roughnessMap!.image as { readonly data: Float32Array };
      return parts.flatMap(({ name }, part) => (texels.data[4 * part]! > 0 ? [name] : []));
    });
  };
  expect((await woven('woman')).sort()).toEqual(['Bottom', 'Top']);
  expect(await woven('mannequin')).toEqual([]);
});

test('the weave is part of a program only while it is on', () => {
  const material = new FlatPartsMaterial([new MeshStandardMaterial(), new MeshStandardMaterial()]);
  const smooth = material.customProgramCacheKey();
  material.setClothWeave(weaveCloth);
  expect(material.customProgramCacheKey()).not.toBe(smooth);
  material.setClothWeave(null);
  expect(material.customProgramCacheKey()).toBe(smooth);
});

test('the weave finds its places in the program of three.js, and reports one that is gone', () => {
  const { vertexShader, fragmentShader } = ShaderLib.standard;
  const program = { vertexShader, fragmentShader };
  weaveCloth(program);
  expect(program.vertexShader).toContain('vRestPosition = position;');
  expect(program.fragmentShader.indexOf('float woven')).toBeGreaterThan(fragmentShader.indexOf('normal_fragment_maps'));
  expect(() => weaveCloth({ vertexShader, fragmentShader: 'void main() {}' })).toThrow('#include <common>');
});
