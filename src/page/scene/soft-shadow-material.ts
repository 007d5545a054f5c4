import { DataTexture, LinearFilter, LinearMipmapLinearFilter, MeshBasicMaterial } from 'three';
import { smoothstep } from 'threepoint/math';

const side = 64;

/**
 * Creates the material of a soft dark spot that fills its surface; `color`: red, green, blue; `opacity`: its middle.
 */
export function createSoftShadowMaterial(color: readonly [number, number, number], opacity: number): MeshBasicMaterial {
  const pixels = new Uint8Array(side * side * 4);
  for (let y = 0; y < side; y++) {
    for (let x = 0; x < side; x++) {
      const out = Math.hypot((x + 0.5) / side - 0.5, (y + 0.5) / side - 0.5) * 2;
      pixels.set([...color, 255 * opacity * (1 - smoothstep(0, 1, out))], (y * side + x) * 4);
    }
  }
  const map = new DataTexture(pixels, side, side);
  map.magFilter = LinearFilter;
  map.minFilter = LinearMipmapLinearFilter;
  map.generateMipmaps = true;
  map.needsUpdate = true;
  return new MeshBasicMaterial({ map, transparent: true, depthWrite: false });
}
