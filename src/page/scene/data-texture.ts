import { DataTexture, LinearFilter } from 'three';
import { anisotropyOf, minFilterOf, type Quality } from './renderer';

/**
 * A square picture of computed pixels (r, g, b, a), on surfaces that are seen from near and from afar at a glancing
 * angle.
 */
export function createDataTexture(pixels: Uint8Array<ArrayBuffer>, side: number, quality: Quality): DataTexture {
  const texture = new DataTexture(pixels, side, side);
  texture.magFilter = LinearFilter;
  texture.minFilter = minFilterOf(quality);
  texture.generateMipmaps = true;
  texture.anisotropy = anisotropyOf(quality);
  texture.needsUpdate = true;
  return texture;
}
