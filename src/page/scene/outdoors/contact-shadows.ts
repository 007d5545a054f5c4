import { Mesh, PlaneGeometry } from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import { createSoftShadowMaterial } from '../soft-shadow-material';

/** Creates soft shadows under standing objects, with and without a shadow map; arena frame. */
export function createContactShadows(
  spots: readonly { readonly x: number; readonly z: number; readonly width: number; readonly depth: number }[],
): Mesh {
  const geometry = mergeGeometries(
    spots.map(({ x, z, width, depth }) => new PlaneGeometry(width, depth).rotateX(-Math.PI / 2).translate(x, 0.01, z)),
  );
  const mesh = new Mesh(geometry, createSoftShadowMaterial([8, 20, 6], 0.42));
  mesh.renderOrder = 1;
  return mesh;
}
