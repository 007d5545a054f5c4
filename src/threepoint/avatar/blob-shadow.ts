import { DataTexture, LinearFilter, LinearMipmapLinearFilter, Mesh, MeshBasicMaterial, PlaneGeometry } from 'three';

/** Returns the opacity at a distance from the centre, 0 to 1. */
const darkness = (out: number): number => (out < 0.45 ? 1 - (0.5 * out) / 0.45 : Math.max(0, (0.5 * (1 - out)) / 0.55));

/** Creates a soft dark disc under the body, which is cheaper than a shadow map. */
export function createBlobShadow(): Mesh<PlaneGeometry, MeshBasicMaterial> {
  const size = 128;
  const pixels = new Uint8Array(size * size * 4);
  for (let y = 0; y < size; y++) {
    for (let x = 0; x < size; x++) {
      const out = Math.hypot((x + 0.5) / size - 0.5, (y + 0.5) / size - 0.5) * 2;
      pixels.set([6, 9, 14, 255 * darkness(out)], (y * size + x) * 4);
    }
  }
  const texture = new DataTexture(pixels, size, size);
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.needsUpdate = true;
  const blob = new Mesh(
    new PlaneGeometry(1.1, 1.1).rotateX(-Math.PI / 2),
    new MeshBasicMaterial({ map: texture, transparent: true, depthWrite: false, toneMapped: false }),
  );
  blob.position.y = 0.006;
  blob.renderOrder = 1;
  return blob;
}
