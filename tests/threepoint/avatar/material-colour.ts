import { type Color, MeshStandardMaterial, type Object3D } from 'three';
import { FlatPartsMaterial } from '../../../src/threepoint/avatar/rig/flat-parts';
import { skinnedMeshesOf } from '../../../src/threepoint/avatar/scene-meshes';

/** Returns the colour of the material of this name, as #rrggbb; “none” without one. */
export function colourOfMaterial(object: Object3D, material: string): string {
  const found: { readonly name: string; readonly color: Color }[] = [];
  for (const { material } of skinnedMeshesOf(object)) {
    if (material instanceof FlatPartsMaterial) found.push(...material.parts);
    else if (material instanceof MeshStandardMaterial) found.push(material);
  }
  const named = found.find(({ name }) => name === material);
  return named ? `#${named.color.getHexString()}` : 'none';
}
