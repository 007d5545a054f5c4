import { DataTexture, LinearFilter, LinearMipmapLinearFilter, Mesh, MeshBasicMaterial, PlaneGeometry } from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';

/** Soft dark spots on the grass that say that things stand on it, with and without a shadow map. Arena frame. */
export function createContactShadows(
  spots: readonly { readonly x: number; readonly z: number; readonly width: number; readonly depth: number }[],
): Mesh {
  const side = 64;
  const pixels = new Uint8Array(side * side * 4);
  for (let y = 0; y < side; y++) {
    for (let x = 0; x < side; x++) {
      const out = Math.hypot((x + 0.5) / side - 0.5, (y + 0.5) / side - 0.5) * 2;
      const strength = Math.max(0, 1 - out);
      pixels.set([8, 20, 6, 255 * strength * strength * (3 - 2 * strength) * 0.42], (y * side + x) * 4);
    }
  }
  const texture = new DataTexture(pixels, side, side);
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.needsUpdate = true;
  const geometry = mergeGeometries(
    spots.map(({ x, z, width, depth }) => new PlaneGeometry(width, depth).rotateX(-Math.PI / 2).translate(x, 0.01, z)),
  );
  const mesh = new Mesh(geometry, new MeshBasicMaterial({ map: texture, transparent: true, depthWrite: false }));
  mesh.renderOrder = 1;
  return mesh;
}
